// How the report looks: on screens, bright and dark, and on paper. The page is XML too: no & and no < here.
#pragma once

namespace dicot::app {

inline constexpr char kReportStyle[] = R"css(
:root {
  color-scheme: light dark;
  --paper: #fcfcfa; --panel: #f3f4ef; --ink: #1c231e; --quiet: #5d675f; --rule: #d9ddd4;
  --leaf: #2f7a46; --left: #1f66a8; --right: #b8561b; --mark: #1c231e;
  --good: #24713d; --usable: #8a6200; --redo: #b3261e; --hatch: #c4574e;
}
@media (prefers-color-scheme: dark) {
  :root {
    --paper: #141815; --panel: #1d231f; --ink: #e6eae4; --quiet: #9aa69d; --rule: #343c36;
    --leaf: #63b87c; --left: #6cb0ee; --right: #ee9a5c; --mark: #f4f6f2;
    --good: #74cf8f; --usable: #e2b548; --redo: #ff8a80; --hatch: #d3736a;
  }
}
* { box-sizing: border-box; }
body {
  margin: 0 auto; max-width: 1120px; padding: 40px 40px 72px; background: var(--paper); color: var(--ink);
  font: 16px/1.5 system-ui, "Segoe UI", "Liberation Sans", "DejaVu Sans", sans-serif;
}
h1, h2, h3, p, ol, ul, figure, table { margin: 0; }
a { color: inherit; text-underline-offset: 3px; text-decoration-color: var(--quiet); }
.over { color: var(--quiet); font-size: 14px; overflow-wrap: anywhere; }
code { white-space: normal; overflow-wrap: anywhere; font-size: 14px; }
.verdict { border-left: 8px solid var(--tone); padding: 2px 0 4px 24px; margin: 14px 0 30px; }
.verdict h1 { color: var(--tone); font-size: 46px; line-height: 1.15; letter-spacing: -0.02em; }
.verdict p { font-size: 19px; margin-top: 4px; max-width: 46em; }
.good { --tone: var(--good); } .usable { --tone: var(--usable); } .redo { --tone: var(--redo); }
.next { background: var(--panel); padding: 16px 24px 18px; border-radius: 6px; }
.next h2 { margin: 0 0 6px; font-size: 16px; border: 0; padding: 0; }
.next ol, .next ul { padding-left: 1.3em; }
.next li + li { margin-top: 4px; }
h2 { font-size: 24px; letter-spacing: -0.01em; margin: 52px 0 4px; padding-top: 18px; border-top: 1px solid var(--rule); }
h3 { font-size: 16px; margin: 26px 0 8px; }
h2 + p, .note { color: var(--quiet); max-width: 52em; }
.note { font-size: 14px; margin-top: 8px; }
.tiles { display: grid; grid-template-columns: repeat(3, 1fr); gap: 1px; background: var(--rule); margin-top: 18px;
  border-top: 1px solid var(--rule); border-bottom: 1px solid var(--rule); }
.tile { background: var(--paper); padding: 16px 16px 18px 0; }
.tile + .tile { padding-left: 20px; }
.tile b { display: block; font-size: 34px; line-height: 1.2; font-weight: 600; letter-spacing: -0.02em; }
.tile b small { font-size: 18px; font-weight: 400; letter-spacing: 0; }
.tile span { display: block; color: var(--quiet); font-size: 14px; }
table { border-collapse: collapse; width: 100%; margin-top: 14px; font-variant-numeric: tabular-nums; }
th, td { text-align: left; vertical-align: baseline; padding: 7px 16px 7px 0; border-bottom: 1px solid var(--rule); }
th { font-weight: 600; white-space: nowrap; }
thead th { color: var(--quiet); font-weight: 400; font-size: 14px; }
td.number { white-space: nowrap; font-weight: 600; }
td.plain { white-space: nowrap; }
td.means { color: var(--quiet); font-size: 15px; }
.two { display: grid; grid-template-columns: 1fr 1fr; gap: 28px 40px; margin-top: 14px; }
figure { min-width: 0; }
p + figure, figure + .two { margin-top: 18px; }
figcaption { font-size: 14px; color: var(--quiet); margin-top: 6px; }
figcaption b { color: var(--ink); font-weight: 600; }
.left { --eye: var(--left); } .right { --eye: var(--right); }
svg { display: block; width: 100%; height: auto; font: 13px/1 system-ui, "Liberation Sans", sans-serif; }
svg.shared { position: absolute; width: 0; height: 0; }
.small svg { max-width: 360px; }
.key { display: inline-block; width: 11px; height: 11px; margin: 0 5px 0 0; border-radius: 2px; background: var(--eye); }
.frame { fill: none; stroke: var(--rule); }
.cell { fill: var(--leaf); stroke: var(--paper); stroke-width: 1.5; }
.none { fill: url(#hatch); } .hatch { stroke: var(--hatch); stroke-width: 1; stroke-opacity: 0.55; fill: none; }
.dots { stroke: var(--ink); stroke-width: 2.6; stroke-linecap: round; stroke-opacity: 0.55; }
.dots.eye { stroke: var(--eye); stroke-width: 3; stroke-opacity: 0.65; }
.shaft { fill: none; stroke: var(--eye); stroke-width: 1; }
.feet { stroke: var(--eye); stroke-width: 2.6; stroke-linecap: round; }
.grid { fill: none; stroke: var(--quiet); stroke-opacity: 0.45; }
.axis { fill: none; stroke: var(--quiet); }
.mark { fill: none; stroke: var(--mark); stroke-width: 1.5; stroke-dasharray: 5 4; }
.tick { stroke: var(--ink); stroke-width: 2; }
.band { fill: var(--leaf); fill-opacity: 0.11; }
.trace { fill: none; stroke: var(--eye, var(--leaf)); stroke-width: 2; stroke-linejoin: round; }
.dots.trace { stroke-width: 8; stroke-opacity: 1; stroke-linecap: round; }
.reach { fill: none; stroke: var(--eye, var(--leaf)); stroke-width: 1.5; }
.gap { fill: var(--quiet); fill-opacity: 0.13; }
.hollow { fill: var(--paper); stroke: var(--hatch); stroke-width: 1.8; }
.life { fill: none; stroke: var(--leaf); stroke-width: 1.2; stroke-opacity: 0.6; stroke-linejoin: round; }
.dots.sample { stroke-width: 5; stroke-opacity: 0.6; } .spread { stroke: var(--ink); stroke-opacity: 0.25; }
.bar { fill: var(--leaf); } .bar.left { fill: var(--left); } .bar.right { fill: var(--right); }
.bar.dropped { fill: none; stroke: var(--eye); stroke-width: 1.5; stroke-dasharray: 3 2; }
.label { fill: var(--quiet); } .middle { text-anchor: middle; } .end { text-anchor: end; }
.chain { fill: none; } .ring { fill: none; stroke-width: 1.6; }
.first { fill: #ff3b30; stroke: #ffffff; stroke-width: 1.6; }
.row0 { stroke: #ff3b30; } .row1 { stroke: #ff9500; } .row2 { stroke: #ffe000; } .row3 { stroke: #2fd65a; }
.row4 { stroke: #00d5e0; } .row5 { stroke: #3d8bff; } .row6 { stroke: #ff4fd8; }
.chain.row0 { marker-mid: url(#ring0); marker-end: url(#ring0); }
.chain.row1 { marker-mid: url(#ring1); marker-end: url(#ring1); }
.chain.row2 { marker-mid: url(#ring2); marker-end: url(#ring2); }
.chain.row3 { marker-mid: url(#ring3); marker-end: url(#ring3); }
.chain.row4 { marker-mid: url(#ring4); marker-end: url(#ring4); }
.chain.row5 { marker-mid: url(#ring5); marker-end: url(#ring5); }
.chain.row6 { marker-mid: url(#ring6); marker-end: url(#ring6); }
.row-line { stroke: #2cff6c; stroke-width: 1.2; vector-effect: non-scaling-stroke; }
.cross { stroke: #ff2d20; stroke-width: 1.4; fill: none; vector-effect: non-scaling-stroke; }
.pair { display: grid; grid-template-columns: 176px 1fr 1fr; gap: 0 16px; padding: 16px 0; border-bottom: 1px solid var(--rule); }
.pair h3 { margin: 0; font-size: 20px; }
.pair p { font-size: 14px; overflow-wrap: anywhere; }
.pair .files { color: var(--quiet); }
.pair .state { font-weight: 600; margin-top: 8px; color: var(--good); }
.pair.out .state { color: var(--redo); }
.pair .lost { color: var(--redo); }
.pair svg { border-radius: 3px; }
@media screen and (max-width: 800px) {
  .facts tr { display: grid; grid-template-columns: 1fr 1.4fr; padding: 8px 0; border-bottom: 1px solid var(--rule); }
  .facts th, .facts td { border: 0; padding: 0; }
  .facts td.number { white-space: normal; }
  .facts .means { grid-column: 1 / 3; }
  body { padding: 24px 18px 48px; }
  .two, .tiles, .pair { grid-template-columns: 1fr; gap: 16px; }
  .tiles { gap: 1px; }
  .tile + .tile { padding-left: 0; }
  .verdict h1 { font-size: 36px; }
}
@media print {
  :root {
    --paper: #ffffff; --panel: #f3f4ef; --ink: #000000; --quiet: #444c46; --rule: #c9cdc4;
    --leaf: #2f7a46; --left: #1f66a8; --right: #b8561b; --mark: #000000;
    --good: #24713d; --usable: #8a6200; --redo: #b3261e; --hatch: #c4574e;
  }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  @page { margin: 14mm; }
  body { max-width: none; padding: 0; font-size: 10pt; }
  td.means, h2 + p, .pair p { font-size: 9pt; }
  .pair { grid-template-columns: 110px 1fr 1fr; }
  h2 { margin-top: 28px; }
  .two { gap: 16px 24px; }
  .pair, figure, tr, .next, .verdict { break-inside: avoid; }
  h2, h3 { break-after: avoid; }
}
)css";

} // namespace dicot::app
