// Sorting and filtering of the table of grasps; without scripts it is a table as it is.
(() => {
  "use strict";
  const table = document.getElementById("grasps");
  const filters = document.getElementById("filters");
  if (!table || !filters) return;
  const body = table.tBodies[0];
  const rows = [...body.rows];
  const said = document.getElementById("shown");

  const valueOf = (row, column) => {
    const cell = row.cells[column];
    const text = cell.dataset.value ?? cell.textContent.trim();
    const number = Number.parseFloat(text.replace("−", "-"));
    return Number.isNaN(number) ? text : number;
  };
  const order = (a, b) => {
    const [isA, isB] = [a, b].map((value) => typeof value === "number");
    if (isA && isB) return a - b;
    if (isA !== isB) return isA ? -1 : 1; // what has no number comes after what has one
    return a.localeCompare(b);
  };
  const sort = (head, column) => {
    const falling = head.getAttribute("aria-sort") === "ascending";
    for (const other of table.tHead.rows[0].cells) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", falling ? "descending" : "ascending");
    const sorted = [...rows].sort((a, b) => order(valueOf(a, column), valueOf(b, column)));
    body.append(...(falling ? sorted.reverse() : sorted));
  };
  for (const [column, head] of [...table.tHead.rows[0].cells].entries()) {
    if (!("key" in head.dataset)) continue;
    const button = document.createElement("button");
    button.type = "button";
    button.append(...head.childNodes);
    head.append(button);
    button.addEventListener("click", () => sort(head, column));
  }

  const filter = () => {
    const text = filters.elements.text.value.trim().toLowerCase();
    const stage = filters.elements.stage.value;
    const reachable = filters.elements.reachable.checked;
    let count = 0;
    for (const row of rows) {
      const fits =
        (!text || row.textContent.toLowerCase().includes(text)) &&
        (!stage || row.dataset.stage === stage) &&
        (!reachable || row.dataset.reachable === "yes");
      row.hidden = !fits;
      count += fits ? 1 : 0;
    }
    said.textContent = `${count} of ${rows.length} grasps`;
  };
  filters.addEventListener("input", filter);
  filters.addEventListener("submit", (event) => event.preventDefault());
  filters.hidden = false;
  filter();

  const open = () => {
    const card = location.hash.length > 1 ? document.getElementById(decodeURIComponent(location.hash.slice(1))) : null;
    if (card && card.tagName === "DETAILS") card.open = true;
  };
  addEventListener("hashchange", open);
  open();
  // On paper every card is open.
  let closed = [];
  addEventListener("beforeprint", () => {
    closed = [...document.querySelectorAll("details:not([open])")];
    for (const card of closed) card.open = true;
  });
  addEventListener("afterprint", () => {
    for (const card of closed) card.open = false;
  });
})();
