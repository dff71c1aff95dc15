"""Style and script of the report, which refers to no other file."""

STYLE = """
:root { color-scheme: light dark; --ink: #1d2630; --soft: #5d6975; --line: #dfe3e7;
  --page: #f7f8f9; --card: #fff; --accent: #c8553d; --good: #2f7a56; --path: #c8553d;
  --world: #8793a0; }
@media (prefers-color-scheme: dark) { :root { --ink: #e6e9ec; --soft: #9aa5b0;
  --line: #2e373f; --page: #14191d; --card: #1b2126; --accent: #e07a5f;
  --good: #6fbf94; --path: #f0926f; --world: #66727f; } }
* { box-sizing: border-box; }
body { font: 15px/1.5 system-ui, sans-serif; color: var(--ink);
  background: var(--page); max-width: 76rem; margin: 0 auto; padding: 2rem 1.5rem; }
h1 { font-size: 1.6rem; margin: 0; letter-spacing: -.01em; }
h2 { font-size: 1.05rem; margin: 2.25rem 0 .6rem; }
p.lead { color: var(--soft); margin: .2rem 0 1.4rem; overflow-wrap: anywhere; }
p.foot { margin-top: 2rem; font-size: .85rem; }
dl { display: grid; grid-template-columns: repeat(auto-fit, minmax(9rem, 1fr));
  gap: 1px; margin: 0; background: var(--line); border: 1px solid var(--line);
  border-radius: .6rem; overflow: hidden; }
dl > div { background: var(--card); padding: .7rem .9rem; }
dt { color: var(--soft); font-size: .8rem; }
dd { margin: 0; font-size: 1.4rem; font-variant-numeric: tabular-nums; }
dd small { display: block; font-size: .75rem; color: var(--soft); }
.outcomes { display: flex; gap: 2px; height: .5rem; margin: .9rem 0 .4rem;
  border-radius: .25rem; overflow: hidden; }
.legend { margin: 0; display: flex; flex-wrap: wrap; gap: .2rem 1.1rem;
  font-size: .8rem; color: var(--soft); }
.legend i { display: inline-block; width: .6rem; height: .6rem; border-radius: 50%;
  margin-right: .35rem; }
i.good { background: var(--good); } i.bad { background: var(--accent); }
.pair { display: grid; gap: 0 2rem; grid-template-columns: repeat(2, minmax(0, 1fr)); }
.scroll { overflow-x: auto; background: var(--card); border: 1px solid var(--line);
  border-radius: .6rem; }
table { border-collapse: collapse; width: 100%; font-variant-numeric: tabular-nums;
  font-size: .9rem; }
th, td { text-align: right; padding: .35rem .9rem; white-space: nowrap;
  border-bottom: 1px solid var(--line); }
tr:last-child td { border-bottom: 0; }
th:first-child, td:first-child { text-align: left; }
th { color: var(--soft); font-weight: 500; font-size: .8rem; }
td.wide { width: 45%; min-width: 6rem; }
.bar { height: .5rem; background: var(--accent); border-radius: .25rem; }
.badge { padding: .05rem .5rem; border-radius: 1rem; font-size: .8rem;
  border: 1px solid var(--line); color: var(--soft); }
.badge.good { color: var(--good); border-color: currentColor; }
.badge.bad { color: var(--accent); border-color: currentColor; }
.tracks { display: grid; gap: 1rem;
  grid-template-columns: repeat(auto-fill, minmax(min(18rem, 100%), 1fr)); }
figure { margin: 0; background: var(--card); border: 1px solid var(--line);
  border-radius: .6rem; overflow: hidden; display: flex; flex-direction: column; }
figure svg { width: 100%; height: 16rem; padding: .6rem; }
figcaption { font-size: .85rem; padding: .7rem .9rem; display: grid; gap: .35rem;
  border-top: 1px solid var(--line); flex: 1; align-content: start; }
figcaption small { color: var(--soft); font-size: .8rem; }
.world { fill: var(--world); } .mark { fill: none; stroke: var(--good); }
.path { fill: none; stroke: var(--path); stroke-linejoin: round; }
.end { fill: var(--path); } .scale { stroke: var(--soft); }
.scale + text { fill: var(--soft); }
.command { display: flex; gap: .5rem; align-items: start; }
code { font-size: .75rem; overflow-wrap: anywhere; color: var(--soft); flex: 1; }
button { font: inherit; font-size: .75rem; padding: .1rem .5rem; cursor: pointer;
  color: var(--soft); background: none; border: 1px solid var(--line);
  border-radius: .35rem; min-width: 4rem; }
button:hover, button:focus-visible { color: var(--ink); border-color: currentColor; }
@media (max-width: 44rem) { .pair { grid-template-columns: minmax(0, 1fr); }
  body { padding: 1.25rem 1rem; } dl { grid-template-columns: 1fr 1fr; }
  dl > div:last-child:nth-child(odd) { grid-column: span 2; }
  button { padding: .4rem .7rem; } }
@media print { button { display: none; } body { background: none; } }
"""

SCRIPT = """
for (const button of document.querySelectorAll("button")) {
  button.onclick = async () => {
    const code = button.previousElementSibling;
    try {
      await navigator.clipboard.writeText(code.textContent);
      button.textContent = "copied";
      setTimeout(() => { button.textContent = "copy"; }, 1500);
    } catch {
      getSelection().selectAllChildren(code);
    }
  };
}
"""
