// SPDX-License-Identifier: Apache-2.0
#include "tracer/report_style.h"

namespace trace {

const std::string_view report_css = R"css(
:root { color-scheme: light dark; --ink: #1d2530; --soft: #5c6b7c; --line: #dde3ea; --page: #f4f6f8; --card: #fff;
  --a: #2f6fb5; --b: #d98324; --c: #3a9a6e; --d: #8a63b8; --e: #7d8794; --bad: #b3362b; --warn: #a36a00; }
@media (prefers-color-scheme: dark) { :root { --ink: #e3e8ee; --soft: #98a5b3; --line: #323b46; --page: #14181d;
  --card: #1c2229; --a: #5a9be0; --b: #e39a4a; --c: #57b98a; --d: #a888d3; --e: #8b97a5; --bad: #ec7a70; --warn: #e0a640; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 14px/1.45 system-ui, "DejaVu Sans", sans-serif; }
main { max-width: 1160px; margin: 0 auto; padding: 24px 20px 60px; }
h1 { font-size: 22px; margin: 0 0 2px; overflow-wrap: anywhere; }
h2 { font-size: 17px; margin: 34px 0 10px; padding-top: 14px; border-top: 1px solid var(--line); overflow-wrap: anywhere; }
h3 { font-size: 12px; margin: 0 0 8px; color: var(--soft); text-transform: uppercase; letter-spacing: .06em; }
table + h3 { margin-top: 16px; } table + p { margin-top: 10px; } p { margin: 0 0 8px; } .soft { color: var(--soft); }
.tiles { display: grid; grid-template-columns: repeat(auto-fit, minmax(130px, 1fr)); gap: 10px; margin: 16px 0; }
.tile, .card { background: var(--card); border: 1px solid var(--line); border-radius: 8px; padding: 12px 14px; }
.tile b { display: block; font-size: 20px; font-weight: 600; font-variant-numeric: tabular-nums; }
.tile span { color: var(--soft); font-size: 12px; }
.grid { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 12px; margin-bottom: 12px; }
.card { overflow-x: auto; } .wide { margin-bottom: 12px; }
@media (max-width: 760px) { .grid { grid-template-columns: minmax(0, 1fr); } }
img { display: block; max-width: 100%; height: auto; margin: 0 auto; border-radius: 4px;
  background: repeating-conic-gradient(#9993 0% 25%, #fff3 0% 50%) 0 0 / 16px 16px; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums; }
th { text-align: left; font-weight: 600; color: var(--soft); font-size: 12px; }
th, td { padding: 4px 10px 4px 0; border-bottom: 1px solid var(--line); vertical-align: top; }
tr:last-child td { border-bottom: 0; } td.n, th.n { text-align: right; white-space: nowrap; }
.options td:first-child { width: 180px; color: var(--soft); } a { color: var(--a); }
td.name, td.text { overflow-wrap: anywhere; } td.text { min-width: 260px; }
th button { all: unset; cursor: pointer; } th button:focus-visible { outline: 2px solid var(--a); }
th button::after { content: " \2195"; opacity: .4; } th[aria-sort=ascending] button::after { content: " \2191"; opacity: 1; }
th[aria-sort=descending] button::after { content: " \2193"; opacity: 1; }
.bar { fill: var(--a); } .bar.b { fill: var(--b); } .bar.c { fill: var(--c); } .bar.d { fill: var(--d); } .bar.e { fill: var(--e); }
.track { fill: var(--line); } svg { display: block; width: 100%; height: 10px; } td svg { margin: 5px 0; min-width: 90px; }
.error, .severe { color: var(--bad); font-weight: 600; } .warning { color: var(--warn); font-weight: 600; }
code { font: 12px/1.5 ui-monospace, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
footer { margin-top: 40px; color: var(--soft); font-size: 12px; }
)css";

// Clicking a heading sorts by that column: numbers by data-v, descending first.
const std::string_view report_script = R"js(
document.querySelectorAll("table.sortable").forEach(function (table) {
  table.querySelectorAll("th button").forEach(function (button) {
    button.addEventListener("click", function () {
      var th = button.parentNode, column = Array.prototype.indexOf.call(th.parentNode.children, th);
      var down = th.getAttribute("aria-sort") !== "descending", body = table.tBodies[0];
      var rows = Array.prototype.slice.call(body.rows);
      var key = function (row) { var c = row.cells[column], v = c.getAttribute("data-v");
        return v === null ? c.textContent : Number(v); };
      rows.sort(function (p, q) { var a = key(p), b = key(q), order = a < b ? -1 : a > b ? 1 : 0;
        return down ? -order : order; });
      th.parentNode.querySelectorAll("th").forEach(function (other) { other.removeAttribute("aria-sort"); });
      th.setAttribute("aria-sort", down ? "descending" : "ascending");
      rows.forEach(function (row) { body.appendChild(row); });
    });
  });
});
)js";

} // namespace trace
