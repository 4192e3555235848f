#include "report/write_html.hpp"

#include "report/html_sections.hpp"
#include "report/html_text.hpp"
#include "report/verdict.hpp"

namespace arris::report {

std::string write_html(const RunRecord& record) {
  std::string html = "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n";
  html += "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n";
  html += html::tag("title", escaped(record.part_number + ": " + correction_word(record) + ", " +
                                     verdict_word(record.inspection_verdict())));
  html += "\n<style>";
  html += page_style();
  html += "</style>\n</head>\n<body>\n";
  html += html::banner(record);
  html += html::facts(record);
  html += html::three_results(record);
  html += html::deviation_section(record);
  html += html::contour_error_section(record);
  html += html::path_section(record);
  html += html::cell_section(record);
  html += html::worst_points_section(record);
  html += html::registration_section(record);
  html += html::notes_and_definitions(record);
  html += html::tag("div", escaped(record.version) + " &middot; result hash " + escaped(record.result_hash),
                    "footer");
  html += "\n<script>";
  html += page_script();
  html += "</script>\n</body>\n</html>\n";
  return html;
}

}  // namespace arris::report
