#include <cmath>

#include "report/html_sections.hpp"
#include "report/html_text.hpp"
#include "report/number_text.hpp"

namespace arris::report::html {

std::string tag(const std::string& name, const std::string& content, const std::string& css) {
  std::string html = "<";
  html.append(name);
  if (!css.empty()) html.append(" class=\"").append(css).append("\"");
  return html.append(">").append(content).append("</").append(name).append(">");
}

std::string picture(const std::string& png, const std::string& alternative, const std::string& caption) {
  if (png.empty()) return {};
  std::string html = "<figure><img alt=\"";
  html.append(escaped(alternative))
      .append("\" src=\"data:image/png;base64,")
      .append(base64(png))
      .append("\">");
  if (!caption.empty()) html += tag("figcaption", escaped(caption));
  return html + "</figure>\n";
}

std::string chart(const std::string& svg, const std::string& caption) {
  if (svg.empty()) return {};
  std::string html = "<figure>";
  html += svg;
  if (!caption.empty()) html += tag("figcaption", escaped(caption));
  return html + "</figure>\n";
}

std::string number_row(const std::vector<std::string>& cells, const std::string& cell) {
  std::string html;
  for (std::size_t i = 0; i < cells.size(); ++i) html += tag(cell, cells[i], i == 0 ? "" : "n");
  return tag("tr", html) + "\n";
}

std::string matrix_table(const RigidMotion& motion) {
  std::string rows;
  for (int row = 0; row < 4; ++row) {
    std::string cells;
    for (int col = 0; col < 4; ++col) cells += tag("td", mm(motion.matrix()(row, col), col == 3 ? 4 : 8));
    rows += tag("tr", cells);
  }
  return tag("div", tag("table", rows, "matrix"), "scroll");
}

std::string mm(double value, int digits) {
  return std::isfinite(value) ? minus_text(value, digits) : "&ndash;";
}
std::string signed_mm(double value, int digits) {
  return std::isfinite(value) ? signed_text(value, digits) : "&ndash;";
}
std::string percent(double ratio, int digits) {
  return std::isfinite(ratio) ? fixed_text(100.0 * ratio, digits) + " %" : "&ndash;";
}

}  // namespace arris::report::html
