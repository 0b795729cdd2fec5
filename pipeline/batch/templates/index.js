
const rows = Array.from(document.querySelectorAll("tbody tr"));
const wanted = (name) => document.getElementById(name).value;

function filter() {
  const words = wanted("text").toLowerCase().split(/\s+/).filter(Boolean);
  let shown = 0;
  for (const row of rows) {
    const said = row.textContent.toLowerCase();
    const fits = words.every((word) => said.includes(word))
      && (!wanted("verdict") || row.dataset.verdict === wanted("verdict"))
      && (!wanted("hand") || row.dataset.hand === wanted("hand"));
    row.hidden = !fits;
    shown += fits;
  }
  document.getElementById("shown").textContent = shown === rows.length ? "" : `${shown} shown.`;
}

document.getElementById("filters").addEventListener("input", filter);
document.getElementById("filters").addEventListener("submit", (event) => event.preventDefault());
