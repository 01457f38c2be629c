// SPDX-License-Identifier: MIT
// The style sheet of a report: light, dark and paper. Colours are variables; the drawings use the same ones.
#pragma once

namespace programs {
namespace html {

inline const char* style() {
  return R"css(
:root{--paper:#fdfdfb;--ink:#1d2126;--soft:#5d656f;--faint:#8d949d;--rule:#d9dcdf;--panel:#f4f4f0;
--blue:#1f5f9e;--pale:#9cc0e2;--orange:#c8561b;--green:#2f7d4f;--amber:#9a6a00;--red:#b0322b;--purple:#6b4fa0}
@media (prefers-color-scheme:dark){:root{--paper:#15181c;--ink:#e4e6e8;--soft:#a6adb5;--faint:#7d858e;--rule:#343a41;
--panel:#1d2126;--blue:#79b0e6;--pale:#3f6a94;--orange:#ee9560;--green:#76c596;--amber:#e0b354;--red:#ef8a80;
--purple:#b39ce0}}
@media print{:root{--paper:#fff;--ink:#000;--soft:#444;--faint:#666;--rule:#bbb;--panel:#f6f6f6;--blue:#1f5f9e;
--pale:#9cc0e2;
--orange:#c8561b;--green:#2f7d4f;--amber:#9a6a00;--red:#b0322b;--purple:#6b4fa0}}
*{box-sizing:border-box}
body{margin:0;background:var(--paper);color:var(--ink);
font:17px/1.58 Charter,"Bitstream Charter","Source Serif 4",Georgia,serif}
main{max-width:1120px;margin:0 auto;padding:56px 36px 96px}
h1{font-size:2.15em;line-height:1.15;font-weight:600;margin:0 0 .25em;letter-spacing:-.01em}
h2{font-size:1.38em;font-weight:600;margin:2.6em 0 .6em;padding-top:.7em;border-top:1px solid var(--rule)}
h3{font-size:1.05em;font-weight:600;margin:1.8em 0 .5em}
p{max-width:44em;margin:.6em 0}
.lead{font-size:1.1em;color:var(--soft)}
.note{color:var(--soft);font-size:.88em;max-width:52em}
a{color:var(--blue);text-decoration:none}
table,svg,.badge,figcaption,nav,.tally,.gap{
font-family:"Inter","Helvetica Neue",Helvetica,Arial,"Liberation Sans",sans-serif}
table{border-collapse:collapse;font-size:.78em;line-height:1.42;font-variant-numeric:tabular-nums lining-nums;
width:100%}
.wide{overflow-x:auto;margin:1em 0 1.2em}
th{font-weight:600;text-align:left;color:var(--soft);border-bottom:1.5px solid var(--ink);padding:5px 9px;
vertical-align:bottom}
td{padding:5px 9px;border-bottom:1px solid var(--rule);vertical-align:top}
thead tr:not(:last-child) th{border-bottom:0;padding-bottom:0}
th.n,td.n{text-align:right;white-space:nowrap}
th.c{text-align:center}
tr.group td{border-bottom:1.2px solid var(--faint)}
td.paper{color:var(--soft)}
td.best{font-weight:700}
td.dev{color:var(--faint);padding-left:0}
th.dev{padding-left:0}
td.key{white-space:nowrap}
.good{color:var(--green)}
.bad{color:var(--red)}
.mild{color:var(--soft)}
table.plain{width:auto;min-width:50%}
.badge{display:inline-block;font-size:.72rem;font-weight:600;letter-spacing:.02em;padding:2px 9px;border-radius:999px;
border:1.2px solid;white-space:nowrap}
.badge.reproduced{color:var(--green)}
.badge.part{color:var(--amber)}
.badge.not{color:var(--red)}
.badge.open{color:var(--faint)}
.tally{display:flex;flex-wrap:wrap;gap:14px;margin:1.6em 0 1.2em;padding:0}
.tally div{flex:1 1 150px;background:var(--panel);border-radius:8px;padding:13px 18px}
.tally b{display:block;font-size:1.75rem;font-weight:600;line-height:1.2}
.tally span{font-size:.8rem;color:var(--soft)}
.claim{display:grid;grid-template-columns:3.2em 1fr auto;gap:2px 10px;padding:15px 0 4px;break-inside:avoid}
.claim .id{color:var(--faint);font-variant-numeric:tabular-nums}
.claim .statement{font-weight:600;max-width:44em}
.claim .rest{grid-column:2/4}
.claim .rule::first-letter{text-transform:uppercase}
.claim table{table-layout:fixed;min-width:700px}
.claim th:first-child{width:25%}
.claim th:last-child{width:21%}
table.overview td{padding-top:7px;padding-bottom:7px;font-size:1.08em}
table.overview .badge{font-size:.86em}
.claim .rule{color:var(--soft);font-size:.84em;margin:.15em 0 .5em;max-width:56em}
.claim .wide{margin:.3em 0 .8em}
.claim table{font-size:.74em}
.claim th{border-bottom-width:1px;border-color:var(--faint)}
.gap{background:var(--panel);border-left:4px solid var(--amber);padding:12px 18px;font-size:.85em;
border-radius:0 6px 6px 0;margin:1.2em 0}
.gap p{margin:.2em 0;max-width:none}
nav{font-size:.84em;display:flex;flex-wrap:wrap;gap:4px 20px;margin:1.4em 0 0;color:var(--soft)}
figure{margin:1.6em 0 2.2em}
figure svg,figure img{display:block;width:100%;height:auto}
figure img{background:#fff;border-radius:4px}
figcaption{font-size:.8em;color:var(--soft);margin-top:.5em;max-width:70em;line-height:1.45}
sup,sub{line-height:0;font-size:.75em}
svg text{fill:var(--ink);font-size:12px}
svg .tick{fill:var(--soft);font-size:11.5px;font-variant-numeric:tabular-nums}
svg .name{fill:var(--soft)}
svg .title{font-weight:600;font-size:13px}
svg .small{font-size:11px;fill:var(--soft)}
svg .middle{text-anchor:middle}
svg .end{text-anchor:end}
svg .grid{stroke:var(--rule);stroke-width:1}
svg .axis{stroke:var(--faint);stroke-width:1.2}
svg path,svg line{fill:none}
svg .first{stroke:var(--blue);stroke-width:1.8}
svg .second{stroke:var(--orange);stroke-width:1.8}
svg .thick{stroke:var(--pale);stroke-width:3.2}
svg .thin{stroke:var(--orange);stroke-width:1.2}
svg .dash{stroke-dasharray:5 4}
svg .cloud{stroke:var(--pale);stroke-width:2.6;stroke-linecap:round}
svg .plus{stroke:var(--orange);stroke-width:.9;opacity:.62}
svg .seed{stroke:var(--blue);stroke-width:5;stroke-linecap:round;opacity:.33}
svg .mean{stroke:var(--ink);stroke-width:2.4}
svg .deviation{stroke:var(--ink);stroke-width:1.3}
svg .reference{fill:var(--paper);stroke:var(--orange);stroke-width:1.8}
svg .reference-line{stroke:var(--orange);stroke-width:1.1;opacity:.7}
svg .red{fill:#c65a50}
svg .green{fill:#4f9c6c}
svg .yellow{fill:#d3a83f}
svg .orange{fill:#d98243}
svg .violet{fill:#8a76b8}
svg .blue{fill:#5b8fc0}
svg .vanilla{opacity:.62}
@page{size:A4;margin:15mm 14mm}
@media print{body{font-size:10pt}main{max-width:none;padding:0}nav{display:none}
figure,tr,.claim,.gap{break-inside:avoid}
h2,h3{break-after:avoid}
h2{margin-top:1.6em}
.wide{overflow:visible}
table{font-size:7.1pt}
th,td{padding:2.5px 4px}
.claim table{min-width:0;font-size:6.9pt}
.claim{grid-template-columns:2em 1fr auto}
.badge{font-size:7pt;padding:1px 6px}
table.overview td{font-size:8pt}}
)css";
}

}  // namespace html
}  // namespace programs
