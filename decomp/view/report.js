// The report's page: tables that are sorted by a click on a heading, and names that are shown in the view.

"use strict";

function value(row, column) {
  const cell = row.cells[column];
  return cell.dataset.value === undefined ? cell.textContent : Number(cell.dataset.value);
}

/** Numbers by size, texts by letters with numbers in them by size; what is empty comes last. */
function compared(one, other, sign) {
  if (one === "" || other === "") return (one === "") - (other === "");
  if (typeof one === "number" && typeof other === "number") return sign * (one - other);
  return sign * String(one).localeCompare(String(other), "en", { numeric: true });
}

for (const head of document.querySelectorAll("th")) {
  head.querySelector("button").addEventListener("click", () => {
    const sign = head.getAttribute("aria-sort") === "ascending" ? -1 : 1;
    for (const other of head.parentElement.cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", sign > 0 ? "ascending" : "descending");
    const rows = [...head.closest("table").tBodies[0].rows];
    rows.sort((a, b) => compared(value(a, head.cellIndex), value(b, head.cellIndex), sign));
    head.closest("table").tBodies[0].append(...rows);
  });
}

const frame = document.getElementById("frame");
let ready = null;

/** The view, opened in the picture's place when it is first asked for. */
function opened() {
  ready ??= new Promise(resolve => {
    frame.addEventListener("load", () => resolve(frame.contentWindow.decompView), { once: true });
    frame.srcdoc = JSON.parse(document.getElementById("page").textContent);
    document.getElementById("view").hidden = false;
    document.getElementById("picture").hidden = true;
  });
  return ready;
}

document.getElementById("picture").addEventListener("click", opened);
for (const link of document.querySelectorAll("a[data-name]")) {
  link.addEventListener("click", async event => {
    event.preventDefault();
    const view = await opened();
    view.only(link.dataset.name, link.dataset.group || null);
    frame.scrollIntoView({ block: "start" });
  });
}
