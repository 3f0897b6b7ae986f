// What the tests of the page want to know of it. Runs in the page, as the body of a function.
const all = (selector, within = document) => [...within.querySelectorAll(selector)];
const overlap = (a, b) => a.left < b.right && b.left < a.right && a.top < b.bottom && b.top < a.bottom;

// Tables: a column as it stands after none, one and two clicks on its heading.
const table = document.querySelector("#runs table");
const heading = name => all("thead th", table).find(th => th.querySelector("button").firstChild.data.trim() === name);
const column = th => {
  const cells = [...table.tBodies[0].rows].map(row => row.cells[th.cellIndex]);
  return cells.map(cell => cell.dataset.v ?? cell.textContent);
};
const sorted = {};
for (const name of ["F", "facets", "chamfer", "method"]) {
  const th = heading(name), states = [column(th)];
  for (let click = 0; click < 2; click++) {
    th.querySelector("button").click();
    states.push(column(th), th.getAttribute("aria-sort"));
  }
  sorted[name] = states;
}
const marked = all("[aria-sort]", table).length;

// A run's viewer: which picture lies on the left and the right of the boundary, at two places of it.
const viewer = document.querySelector(".run .viewer"), pair = viewer.querySelector(".pair");
const range = viewer.querySelector("input[type=range]");
viewer.scrollIntoView();
const under = x => {
  const box = pair.getBoundingClientRect();
  return document.elementFromPoint(box.left + x, box.top + 12)?.dataset.name ?? null;
};
const slide = value => {
  range.value = value;
  range.dispatchEvent(new Event("input"));
};
const sides = [];
for (const value of [80, 220]) {
  slide(value);
  sides.push([under(value - 40), under(value + 40)]);
}
const drag = (type, x, pointerType) => pair.dispatchEvent(new PointerEvent(type, {
  bubbles: true, cancelable: true, pointerType, clientX: pair.getBoundingClientRect().left + x,
}));
const dragged = [];
for (const pointerType of ["mouse", "touch"]) {
  slide(150);
  drag("pointerdown", 60, pointerType);
  drag("pointermove", 90, pointerType);
  drag("pointerup", 90, pointerType);
  drag("pointermove", 10, pointerType);
  dragged.push(range.value);
}

// A scene's viewer: its pictures before and after another choice.
const chooser = document.querySelector(".chooser");
const chosen = () => all("img", chooser).map(image => [image.dataset.name, image.src.length]);
const choices = [chosen()];
for (const select of all("select", chooser)) {
  select.selectedIndex = 3;
  select.dispatchEvent(new Event("change"));
}
choices.push(chosen());
const chooserSources = all("img", chooser).map(image => image.src);
const below = select => all(".run img").find(image => image.dataset.name === select.value);
const runSources = all("select", chooser).map(select => below(select).src);

// Everything that can be seen without a choice: sizes of pictures, texts that lie on each other.
for (const run of all("details")) run.open = true;
while (!all("img").every(image => image.complete)) await new Promise(done => setTimeout(done, 20));
const pictures = all("img").map(image => {
  const box = image.getBoundingClientRect();
  return [image.naturalWidth, box.width, box.height > 0];
});
const texts = all("svg text").map(text => [text.textContent, text.getBoundingClientRect()]);
const overlaps = texts.flatMap(([text, box], i) =>
  texts.slice(0, i).filter(([, other]) => overlap(box, other)).map(([other]) => `${text} / ${other}`));
return {
  sorted, marked, sides, dragged, choices, chooserSources, runSources, pictures, overlaps,
  texts: texts.length, controls: all(".controls").filter(c => c.offsetHeight > 0).length,
  wide: document.documentElement.scrollWidth - innerWidth, width: innerWidth,
};
