#include "apps/cli/html.h"

namespace percale::cli {
namespace {

constexpr std::string_view kStyle = R"(
:root { color-scheme: light dark; --page: #fbfaf7; --card: #fff; --ink: #1d2126; --soft: #5c646e; --line: #dcd9d2;
  --holds: #00664a; --partly: #8a5a00; --fails: #a8321a; --s0: #0072b2; --s1: #d55e00; --s2: #009e73; --s3: #b0568f;
  --s4: #b98300; --s5: #3c6fc9; }
@media (prefers-color-scheme: dark) { :root { --page: #15181b; --card: #1e2226; --ink: #e8e6e1; --soft: #a4abb3;
  --line: #373d43; --holds: #4cc9a0; --partly: #e6b34a; --fails: #f28b70; --s0: #56b4e9; --s1: #f08a48; --s2: #3fc79b;
  --s3: #dd93c0; --s4: #e6b84a; --s5: #8fb0f0; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--page); color: var(--ink); font: 1rem/1.5 system-ui, sans-serif; }
main { max-width: 84rem; margin: 0 auto; padding: 1.5rem clamp(.8rem, 3vw, 2.5rem) 4rem; }
h1 { font-size: clamp(1.6rem, 4vw, 2.3rem); line-height: 1.2; margin: .5rem 0; }
h2 { font-size: 1.45rem; margin: 3rem 0 .8rem; border-bottom: 2px solid var(--line); padding-bottom: .3rem; }
h3 { font-size: 1.1rem; margin: 2rem 0 .6rem; }
p.lead, .soft { color: var(--soft); }
a { color: var(--s0); }
nav ul { list-style: none; padding: 0; display: flex; flex-wrap: wrap; gap: .4rem 1.2rem; }
.figures { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 24rem), 1fr)); gap: 1.2rem; }
figure { margin: 0; background: var(--card); border: 1px solid var(--line); border-radius: .6rem; overflow: hidden; }
figure img { display: block; width: 100%; height: auto; background: #404040; }
figcaption { padding: .8rem 1rem 1rem; }
figcaption b { font-weight: 650; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: .1rem .9rem; margin: .7rem 0; font-size: .9rem; }
dt { color: var(--soft); }
dd { margin: 0; overflow-wrap: anywhere; }
pre { margin: .6rem 0 0; padding: .6rem .7rem; overflow-x: auto; background: var(--page); border: 1px solid var(--line);
  border-radius: .4rem; font: .78rem/1.45 ui-monospace, monospace; white-space: pre-wrap; overflow-wrap: anywhere; }
.claim { background: var(--card); border: 1px solid var(--line); border-left: .35rem solid var(--line);
  border-radius: .4rem; padding: .6rem 1rem; margin: .6rem 0; }
.claim p { margin: .25rem 0; }
.claim.holds { border-left-color: var(--holds); }
.claim.partly { border-left-color: var(--partly); }
.claim.fails { border-left-color: var(--fails); }
.verdict { font-weight: 650; white-space: nowrap; }
.holds .verdict { color: var(--holds); }
.partly .verdict { color: var(--partly); }
.fails .verdict { color: var(--fails); }
.plots { display: grid; grid-template-columns: repeat(auto-fill, minmax(min(100%, 30rem), 1fr)); gap: 1.2rem; margin: 1.2rem 0; }
.plot { display: block; width: 100%; height: auto; background: var(--card); border: 1px solid var(--line); border-radius: .6rem; }
.plot text { fill: var(--ink); font: 13px system-ui, sans-serif; }
.plot .title { font-weight: 650; font-size: 15px; }
.plot .grid { stroke: var(--line); stroke-width: 1; }
.plot .axis { stroke: var(--soft); stroke-width: 1.2; }
.plot path { fill: none; stroke-width: 2; stroke-linejoin: round; }
.plot .s0 path { stroke: var(--s0); } .plot .s0 .mark { fill: var(--s0); }
.plot .s1 path { stroke: var(--s1); stroke-dasharray: 7 3; } .plot .s1 .mark { fill: var(--s1); }
.plot .s2 path { stroke: var(--s2); stroke-dasharray: 2 3; } .plot .s2 .mark { fill: var(--s2); }
.plot .s3 path { stroke: var(--s3); } .plot .s4 path { stroke: var(--s4); } .plot .s5 path { stroke: var(--s5); }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: .4rem 0 1rem; font-size: .92rem; }
caption { text-align: left; font-weight: 650; padding: .4rem 0; }
th, td { padding: .35rem .8rem; border-bottom: 1px solid var(--line); text-align: right; font-variant-numeric: tabular-nums; }
td { white-space: nowrap; }
th { vertical-align: bottom; color: var(--soft); font-weight: 550; }
th:first-child, td:first-child { text-align: left; }
.overview td { text-align: left; white-space: normal; }
)";

}  // namespace

std::string EscapeHtml(std::string_view text) {
  std::string html;
  for (const char c : text) {
    switch (c) {
      case '&':
        html += "&amp;";
        break;
      case '<':
        html += "&lt;";
        break;
      case '>':
        html += "&gt;";
        break;
      case '"':
        html += "&quot;";
        break;
      case '\'':
        html += "&#39;";
        break;
      default:
        html += c;
    }
  }
  return html;
}

std::string Element(std::string_view name, std::string_view text) {
  const std::string tag(name);
  return "<" + tag + ">" + EscapeHtml(text) + "</" + tag + ">";
}

std::string OpenPage(std::string_view title, std::string_view heading) {
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n" +
         Element("title", title) + "\n<link rel=\"icon\" href=\"data:,\">\n<style>" + std::string(PageStyle()) +
         "</style>\n</head>\n<body>\n<main>\n" + Element("h1", heading) + "\n";
}

std::string_view ClosePage() {
  return "</main>\n</body>\n</html>\n";
}

std::string_view PageStyle() {
  return kStyle;
}

}  // namespace percale::cli
