#include "report/html_text.hpp"

#include <array>
#include <cstdint>

namespace arris::report {
namespace {

constexpr std::string_view kReplacement = "\xEF\xBF\xBD";

// Length of the well-formed UTF-8 sequence at the front; 0: broken.
std::size_t sequence_length(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t length = lead < 0x80   ? 1
                             : lead < 0xC2 ? 0
                             : lead < 0xE0 ? 2
                             : lead < 0xF0 ? 3
                             : lead < 0xF5 ? 4
                                           : 0;
  if (length == 0 || text.size() < length) return 0;
  for (std::size_t i = 1; i < length; ++i)
    if ((byte(i) & 0xC0U) != 0x80U) return 0;
  const bool overlong = (lead == 0xE0 && byte(1) < 0xA0) || (lead == 0xF0 && byte(1) < 0x90);
  const bool surrogate = lead == 0xED && byte(1) >= 0xA0, beyond = lead == 0xF4 && byte(1) >= 0x90;
  return overlong || surrogate || beyond ? 0 : length;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  while (!text.empty()) {
    const std::size_t length = sequence_length(text);
    const char c = text.front();
    const bool is_control =
        length == 1 && (static_cast<unsigned char>(c) < 0x20 || c == 0x7F) && c != '\n' && c != '\t';
    if (length == 0 || is_control)
      safe += kReplacement;
    else if (c == '&')
      safe += "&amp;";
    else if (c == '<')
      safe += "&lt;";
    else if (c == '>')
      safe += "&gt;";
    else if (c == '"')
      safe += "&quot;";
    else if (c == '\'')
      safe += "&#39;";
    else
      safe += text.substr(0, length);
    text.remove_prefix(length == 0 ? 1 : length);
  }
  return safe;
}

std::string base64(std::string_view bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t word = 0;
    for (std::size_t k = 0; k < 3; ++k)
      word = (word << 8U) | (k < count ? static_cast<unsigned char>(bytes[i + k]) : 0U);
    for (std::size_t k = 0; k < 4; ++k) text += k <= count ? kDigits[(word >> (18U - 6U * k)) & 63U] : '=';
  }
  return text;
}

std::string_view page_style() {
  return R"css(
:root { color-scheme: light; --ink: #1d2126; --soft: #5c6570; --line: #d5dae0; --pale: #f4f6f8;
  --good: #17703c; --bad: #b3261e; --unsure: #8a5a00; --none: #4b5560; }
* { box-sizing: border-box; }
body { margin: 0 auto; max-width: 920px; padding: 20px 24px 48px; background: #fff; color: var(--ink);
  font: 16px/1.5 "Segoe UI", Roboto, "Helvetica Neue", Arial, "Liberation Sans", "DejaVu Sans", sans-serif; }
h1 { font-size: 25px; margin: 0 0 2px; overflow-wrap: anywhere; }
h2 { font-size: 20px; margin: 34px 0 10px; padding-bottom: 4px; border-bottom: 2px solid var(--ink); break-after: avoid; }
h3 { font-size: 16.5px; margin: 20px 0 6px; break-after: avoid; }
p { margin: 6px 0 10px; }
.soft { color: var(--soft); }
.mono { font-family: "DejaVu Sans Mono", Consolas, Menlo, monospace; font-size: 12.5px; overflow-wrap: anywhere; }
.top { display: flex; justify-content: space-between; gap: 20px; align-items: baseline; }
.verdicts { display: grid; grid-template-columns: repeat(2, minmax(0, 1fr)); gap: 14px; margin: 14px 0; }
.verdict { border-radius: 10px; padding: 16px 18px; color: #fff; display: flex; gap: 16px; align-items: flex-start; }
.verdict svg { flex: none; width: 54px; height: 54px; }
.verdict .what { font-size: 15px; opacity: 0.92; }
.verdict .word { font-size: clamp(22px, 3.1vw, 30px); overflow-wrap: anywhere; font-weight: 700; line-height: 1.1; letter-spacing: 0.01em; }
.verdict .why { font-size: 15px; margin-top: 6px; overflow-wrap: anywhere; }
.good { background: var(--good); } .bad { background: var(--bad); } .unsure { background: var(--unsure); }
.none { background: var(--none); }
.next { border: 2px solid var(--ink); border-radius: 10px; padding: 10px 18px 12px; font-size: 18px; }
.next ol { margin: 4px 0 0; padding-left: 24px; }
.next li { margin: 3px 0; }
.reasons { border-left: 6px solid var(--bad); background: #fdf1f0; padding: 10px 16px; margin: 14px 0; font-size: 17px; }
.reasons ul { margin: 4px 0 0; padding-left: 22px; overflow-wrap: anywhere; }
.facts { display: grid; grid-template-columns: repeat(2, 1fr); gap: 0 28px; }
.facts dl, .facts section { margin: 0; break-inside: avoid; }
dl { display: grid; grid-template-columns: max-content 1fr; gap: 2px 14px; margin: 4px 0; }
dt { color: var(--soft); } dd { margin: 0; overflow-wrap: anywhere; }
.results { display: grid; grid-template-columns: repeat(3, 1fr); gap: 14px; }
.result { border: 1px solid var(--line); border-top: 6px solid var(--none); border-radius: 8px; padding: 10px 14px 12px;
  break-inside: avoid; }
.result.good { border-top-color: var(--good); } .result.bad { border-top-color: var(--bad); }
.result.unsure { border-top-color: var(--unsure); }
.result.good, .result.bad, .result.unsure, .result.none { background: #fff; }
.result h3 { margin: 0 0 4px; }
.result .word { font-size: 21px; font-weight: 700; }
.result.good .word { color: var(--good); } .result.bad .word { color: var(--bad); }
.result.unsure .word { color: var(--unsure); } .result.none .word { color: var(--none); }
table { border-collapse: collapse; width: 100%; margin: 6px 0 12px; font-size: 15px; }
th, td { padding: 5px 9px; border-bottom: 1px solid var(--line); text-align: left; vertical-align: top; }
th { background: var(--pale); font-weight: 600; }
tr { break-inside: avoid; }
.terms th { white-space: nowrap; }
td.n, th.n { text-align: right; font-variant-numeric: tabular-nums; white-space: nowrap; }
td.hash { width: 59%; font-size: 10.8px; padding-top: 9px; }
.out { color: var(--bad); font-weight: 600; }
.scroll { overflow-x: auto; }
.matrix td { font-family: "DejaVu Sans Mono", Consolas, Menlo, monospace; font-size: 13px; text-align: right; }
.swatch { display: inline-block; width: 26px; height: 14px; border: 1px solid #777; vertical-align: -2px; }
.hatch { background: repeating-linear-gradient(135deg, #d0d0d0 0 4px, #eeeeee 4px 9px); }
figure { margin: 10px 0 18px; break-inside: avoid; }
figure img, figure svg { display: block; width: 100%; height: auto; }
figcaption { color: var(--soft); font-size: 14.5px; margin-top: 4px; }
.chart text { font-family: inherit; font-size: 13.5px; fill: var(--ink); }
.chart .soft { fill: var(--soft); }
.chart .readout { font-weight: 600; paint-order: stroke; stroke: #fff; stroke-width: 5px; }
.footer { margin-top: 40px; border-top: 1px solid var(--line); padding-top: 8px; font-size: 13px; color: var(--soft);
  overflow-wrap: anywhere; }
@media (max-width: 640px) { .verdicts, .results, .facts { grid-template-columns: 1fr; } }
@page { size: A4; margin: 13mm 12mm; }
@media print {
  body { max-width: none; padding: 0; font-size: 10.5pt; }
  * { -webkit-print-color-adjust: exact; print-color-adjust: exact; }
  h2 { margin-top: 18px; } table { font-size: 9pt; break-inside: avoid; } th, td { padding: 2.5px 7px; }
  .next { font-size: 12pt; } .reasons { font-size: 11pt; } td.hash { font-size: 7pt; padding-top: 4px; }
  .scroll { overflow: visible; }
  figure img { max-height: 150mm; object-fit: contain; object-position: left; }
}
)css";
}

// A read-out under the finger or the pointer: the nearest position of a chart, and each line's value there.
std::string_view page_script() {
  return R"js(
document.querySelectorAll('svg.chart[data-x]').forEach(function (svg) {
  var numbers = function (text) { return text.split(' ').map(function (t) { return t === '-' ? NaN : Number(t); }); };
  var x = numbers(svg.dataset.x), frame = numbers(svg.dataset.frame), range = numbers(svg.dataset.range);
  var lines = svg.dataset.y.split('|').map(numbers), names = JSON.parse(svg.dataset.names);
  var cursor = svg.querySelector('.cursor'), text = svg.querySelector('.readout');
  var show = function (event) {
    var box = svg.getBoundingClientRect(), scale = 860 / box.width;
    var at = range[0] + ((event.clientX - box.left) * scale - frame[0]) / (frame[1] - frame[0]) * (range[1] - range[0]);
    var best = 0;
    for (var i = 1; i < x.length; i++) if (Math.abs(x[i] - at) < Math.abs(x[best] - at)) best = i;
    var px = frame[0] + (x[best] - range[0]) / (range[1] - range[0]) * (frame[1] - frame[0]);
    cursor.setAttribute('x1', px); cursor.setAttribute('x2', px); cursor.setAttribute('visibility', 'visible');
    text.textContent = x[best].toFixed(1) + ' mm:  ' + lines.map(function (line, k) {
      return names[k] + ' ' + (isNaN(line[best]) ? 'no data' : line[best].toFixed(3));
    }).join(',  ');
  };
  svg.addEventListener('pointermove', show);
  svg.addEventListener('pointerdown', show);
  svg.addEventListener('pointerleave', function () { cursor.setAttribute('visibility', 'hidden'); text.textContent = ''; });
});
)js";
}

}  // namespace arris::report
