//! A page in a headless browser: what a script finds there, and everything that went wrong on the way.
//!
//! The page gets a hook before everything else, which records errors and what was fetched, and a probe at its end,
//! whose findings are written beside the frame the page stands in, and read from the dump of the whole. The browser's
//! own log tells what no hook sees.

use std::fs::{self, File};
use std::io::{Write, stderr};
use std::path::PathBuf;
use std::process::{Command, Stdio};
use std::thread;
use std::time::{Duration, Instant};

use serde_json::Value;

/// Longest time for a page, its start included.
const PATIENCE: Duration = Duration::from_secs(120);

/// Records what goes wrong; stands before anything that can.
const HOOK: &str = r#"<script>
window.trouble = [];
const complain = (what, ...words) => window.trouble.push([what, ...words].join(" "));
addEventListener("error", e => complain("error", e.message ?? "", e.target?.src ?? e.target?.href ?? ""), true);
addEventListener("unhandledrejection", e => complain("rejection", e.reason));
document.addEventListener("securitypolicyviolation", e => complain("forbidden", e.blockedURI));
for (const level of ["error", "warn"]) console[level] = (...words) => complain("console", level, ...words);
</script>"#;

/// Runs the probe when everything is there. `PROBE` is the body of an asynchronous function.
const TAIL: &str = r#"<script>
addEventListener("load", async () => {
  let found = null;
  try { found = await (async () => { PROBE })(); } catch (e) { complain("probe", e); }
  for (const entry of performance.getEntriesByType("resource")) {
    if (!entry.name.startsWith("data:")) complain("fetched", entry.name);
  }
  const findings = document.createElement("pre");
  findings.id = "findings";
  const escaped = c => "\\u" + c.charCodeAt(0).toString(16).padStart(4, "0");
  findings.textContent = JSON.stringify({ found, trouble }).replace(/[<>&\u0080-\uffff]/g, escaped);
  parent.document.body.append(findings);
});
</script>"#;

/// A browser that is installed here.
pub struct Browser(PathBuf);

/// What came of a visit.
pub struct Visit {
    /// What the probe returned.
    pub found: Value,
    /// Errors, warnings and what was fetched.
    pub trouble: Vec<String>,
}

impl Browser {
    /// One on the `PATH`. `None`, with a line that says so, where there is none: the test that called is skipped.
    pub fn find() -> Option<Self> {
        let path = std::env::var_os("PATH").unwrap_or_default();
        let names = ["chromium", "chromium-browser", "google-chrome"];
        let found = std::env::split_paths(&path).flat_map(|folder| names.map(|name| folder.join(name)));
        let found = found.into_iter().find(|file| file.is_file());
        if found.is_none() {
            // Past the capture of the test harness, which shows nothing of a test that passes.
            let _ = writeln!(stderr(), "SKIP {}: install chromium", thread::current().name().unwrap_or("test"));
        }
        found.map(Self)
    }

    /// Opens the page, so many pixels wide, and runs the probe in it.
    ///
    /// # Panics
    /// When the browser fails, or nothing was found: a page that was not read is no page without errors.
    pub fn visit(&self, page: &str, probe: &str, width: u32) -> Visit {
        let folder = tempfile::tempdir().expect("a folder");
        let file = folder.path().join("page.html");
        let tail = TAIL.replace("PROBE", probe);
        let (head, body) = ("<head>", "</body>");
        assert!(page.contains(head) && page.contains(body), "the page has no head or no body");
        let hooked = page.replacen(head, &format!("{head}{HOOK}"), 1).replacen(body, &format!("{tail}{body}"), 1);
        // In a frame, since windows are not as narrow as a telephone.
        let source = hooked.replace('&', "&amp;").replace('"', "&quot;");
        let frame = format!("<iframe style=\"width:{width}px; height:900px; border:0\" srcdoc=\"{source}\"></iframe>");
        fs::write(&file, format!("<!doctype html><body>{frame}</body>")).expect("page.html");
        let [dump, log] = ["dump.html", "log.txt"].map(|name| folder.path().join(name));
        let mut child = Command::new(&self.0)
            .args(["--headless", "--no-sandbox", "--disable-gpu", "--disable-quic", "--no-first-run"])
            .args(["--disable-background-networking", "--disable-component-update", "--disable-sync"])
            .arg(format!("--user-data-dir={}", folder.path().join("profile").display()))
            .args(["--enable-logging=stderr", "--virtual-time-budget=10000", "--dump-dom"])
            .args(["--window-size=1600,1000", &format!("file://{}", file.display())])
            .stdout(File::create(&dump).expect("dump.html"))
            .stderr(File::create(&log).expect("log.txt"))
            .stdin(Stdio::null())
            .spawn()
            .expect("the browser starts");
        let start = Instant::now();
        while child.try_wait().expect("a status").is_none() {
            if start.elapsed() > PATIENCE {
                child.kill().expect("the browser can be stopped");
                panic!("the browser took longer than {PATIENCE:?}");
            }
            thread::sleep(Duration::from_millis(20));
        }
        let [dump, log] =
            [dump, log].map(|file| String::from_utf8_lossy(&fs::read(file).expect("output")).into_owned());
        let findings = dump.rsplit_once("<pre id=\"findings\">").and_then(|(_, rest)| rest.split_once("</pre>"));
        let findings = findings.unwrap_or_else(|| panic!("the probe did not run: {log}")).0;
        let mut findings: Value = serde_json::from_str(findings).expect("findings");
        let trouble = findings["trouble"].as_array().expect("trouble").iter().map(|t| t.to_string());
        let trouble = trouble.chain(log.lines().filter(|line| line.contains("CONSOLE")).map(str::to_owned)).collect();
        Visit { found: findings["found"].take(), trouble }
    }
}
