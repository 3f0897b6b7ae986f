// Two things a page can do that paper cannot: sort tables, and move the boundary between two pictures.
"use strict";
(() => {
  document.documentElement.classList.add("js");

  // Tables: by the cell's number (data-v, empty where there is none: last in either order), else by its text.
  function sort(heading) {
    const table = heading.closest("table"), body = table.tBodies[0], column = heading.cellIndex;
    const down = heading.getAttribute("aria-sort") === "ascending";
    for (const other of heading.parentNode.cells) other.removeAttribute("aria-sort");
    heading.setAttribute("aria-sort", down ? "descending" : "ascending");
    const key = row => row.cells[column].dataset.v ?? row.cells[column].textContent;
    const compare = (a, b) => {
      if (a === "" || b === "") return (a === "") - (b === "");
      const order = isNaN(a) || isNaN(b) ? a.localeCompare(b) : a - b;
      return down ? -order : order;
    };
    body.append(...[...body.rows].sort((a, b) => compare(key(a), key(b))));
  }
  for (const button of document.querySelectorAll(".sortable th button")) {
    button.addEventListener("click", () => sort(button.closest("th")));
  }

  // Pictures: each stands in the page once, and is taken from there.
  const sources = new Map();
  for (const image of document.querySelectorAll("img[data-name]")) sources.set(image.dataset.name, image.src);

  for (const viewer of document.querySelectorAll(".viewer")) {
    const pair = viewer.querySelector(".pair"), range = viewer.querySelector("input");
    for (const select of viewer.querySelectorAll("select")) {
      let image = pair.querySelector(`img.${select.className}`);
      if (!image) {
        image = pair.firstElementChild.cloneNode();
        image.className = select.className;
        pair.append(image);
      }
      const choose = () => {
        image.src = sources.get(select.value);
        image.dataset.name = select.value;
        image.alt = select.selectedOptions[0].textContent;
      };
      select.addEventListener("change", choose);
      choose();
    }

    const handle = document.createElement("span");
    handle.className = "handle";
    pair.append(handle);
    const show = () => pair.style.setProperty("--divide", `${range.value}px`);
    range.addEventListener("input", show);
    // Where the page is narrower than the picture, the boundary begins in sight.
    range.value = Math.min(range.max, document.querySelector("main").clientWidth) / 2;
    show();

    // A mouse drags anywhere; a finger the line only, since elsewhere it scrolls.
    pair.addEventListener("pointerdown", event => {
      if (event.button || (event.pointerType !== "mouse" && event.target !== handle)) return;
      event.preventDefault();
      const move = at => {
        range.value = at.clientX - pair.getBoundingClientRect().left;
        show();
      };
      const stop = new AbortController();
      addEventListener("pointermove", move, stop);
      for (const end of ["pointerup", "pointercancel"]) addEventListener(end, () => stop.abort(), stop);
      move(event);
    });
  }

  // The first run of each scene stays open: a long page is long to scroll. On paper all are.
  const runs = [...document.querySelectorAll("details.run")];
  for (const run of runs) run.open = !run.previousElementSibling?.matches("details.run");
  let open = [];
  addEventListener("beforeprint", () => {
    open = runs.map(run => run.open);
    for (const run of runs) run.open = true;
  });
  addEventListener("afterprint", () => runs.forEach((run, i) => { run.open = open[i]; }));
})();
