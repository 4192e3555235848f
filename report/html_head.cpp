#include <cmath>

#include "report/html_sections.hpp"
#include "report/html_text.hpp"
#include "report/number_text.hpp"
#include "report/statistics.hpp"
#include "report/verdict.hpp"

namespace arris::report::html {
namespace {

// Shape as well as colour: tick, cross, question mark, bar.
std::string icon(const std::string& css) {
  const std::string ring = "<circle cx=\"27\" cy=\"27\" r=\"24\"/>";
  std::string shape = "<path d=\"M15 27 H39\"/>";
  if (css == "good") shape = "<path d=\"M15 28 L24 37 L40 18\"/>";
  if (css == "bad") shape = "<path d=\"M17 17 L37 37 M37 17 L17 37\"/>";
  if (css == "unsure") shape = "<path d=\"M19 21 C19 11 35 11 35 21 C35 27 27 27 27 33 M27 39 V40\"/>";
  return "<svg viewBox=\"0 0 54 54\" fill=\"none\" stroke=\"#fff\" stroke-width=\"4.5\" "
         "stroke-linecap=\"round\" "
         "aria-hidden=\"true\">" +
         ring + shape + "</svg>";
}

std::string css_of(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "good";
    case Verdict::kFail:
      return "bad";
    case Verdict::kIndeterminate:
      return "unsure";
    case Verdict::kNotJudged:
      break;
  }
  return "none";
}

std::string css_of_correction(const RunRecord& record) {
  if (!record.accepted()) return "bad";
  return record.has_toolpath ? "good" : "none";
}

std::string card(const std::string& css, const std::string& what, const std::string& word,
                 const std::string& why) {
  return tag("div",
             icon(css) + tag("div", tag("div", escaped(what), "what") + tag("div", escaped(word), "word") +
                                        tag("div", escaped(why), "why")),
             "verdict " + css);
}

std::string correction_why(const RunRecord& record) {
  if (!record.accepted()) {
    const std::size_t more = record.refusals.size() - 1;
    return record.refusals.front() + (more == 0 ? "" : " (and " + std::to_string(more) + " more)");
  }
  if (!record.has_toolpath) return "this was an inspection without a tool path";
  if (record.frame_refused()) return "the corrected path is good in the scan's frame; no program: see below";
  if (record.program_written) return "the corrected path may be used; programs: " + record.program_note;
  return "the corrected path may be used" + (record.program_note.empty() ? "" : "; " + record.program_note);
}

const Judged& deciding(const RunRecord& record) {
  return record.state == "free" ? record.judged_as_scanned : record.judged_pulled_back;
}

std::string inspection_why(const RunRecord& record) {
  const std::string& text = deciding(record).text;
  return text.empty() && !record.accepted() ? "the run was refused before anything could be judged" : text;
}

std::string list_of(const std::string& kind, const std::vector<std::string>& lines) {
  std::string items;
  for (const std::string& entry : lines) items += tag("li", escaped(entry));
  return tag(kind, items);
}

// Two-column facts: names and finished HTML.
using Facts = std::vector<std::pair<std::string, std::string>>;
std::string list(const std::string& title, const Facts& facts) {
  std::string rows;
  for (const auto& [name, value] : facts)
    rows += tag("dt", escaped(name)) + tag("dd", value.empty() ? "&ndash;" : value);
  return tag("section", tag("h3", escaped(title)) + tag("dl", rows)) + "\n";
}

std::string inputs_table(const RunRecord& record) {
  std::string rows = "<tr><th>input</th><th>file</th><th>SHA-256</th></tr>\n";
  for (const InputFile& input : record.inputs)
    rows += tag("tr", tag("td", escaped(input.role)) + tag("td", escaped(input.name)) +
                          tag("td", escaped(input.sha256), "mono hash")) +
            "\n";
  return tag("table", rows);
}

// Standard deviations from the covariance: the three turns and the three moves, each in its own unit.
std::string standard_deviations(const AlignmentSummary& alignment) {
  if (alignment.covariance_6x6.size() != 36) return "not known";
  std::string text;
  for (std::size_t i = 0; i < 6; ++i) {
    const double sd = std::sqrt(std::max(0.0, alignment.covariance_6x6[7 * i]));
    const char* const names[] = {"turn X", "Y", "Z", "move X", "Y", "Z"};
    if (i > 0) text += i == 3 ? " mrad; " : ", ";
    text.append(names[i]).append(" ").append(fixed_text(i < 3 ? 1000.0 * sd : sd, 4));
  }
  return text + " mm";
}

std::string joined(const std::vector<std::string>& lines, const std::string& none) {
  std::string text;
  for (const std::string& entry : lines) text += (text.empty() ? "" : "; ") + entry;
  return text.empty() ? none : text;
}

Facts alignment_facts(const RunRecord& record) {
  const AlignmentSummary& a = record.alignment;
  return {
      {"start", escaped(a.start)},
      {"side decided by", escaped(a.side_decided_by)},
      {"rms, point to plane", mm(a.rms_mm) + " mm over " + grouped_text(a.pairs) + " kept pairs in the band"},
      {"overlap", percent(a.overlap_ratio)},
      {"second best pose", mm(a.runner_up_ratio, 2) + " times the score of the best (near 1: ambiguous)"},
      {"poses that give the same path", std::to_string(a.equal_poses)},
      {"free directions", escaped(joined(a.free_directions, "none"))},
      {"standard deviations", escaped(standard_deviations(a))}};
}

struct Result {
  std::string css, title, word, what, text;
};
std::string result_card(const Result& r) {
  return tag("div",
             tag("h3", escaped(r.title)) + tag("div", escaped(r.word), "word") + tag("p", escaped(r.what)) +
                 (r.text == r.word ? "" : tag("p", escaped(r.text), "soft")),
             "result " + r.css);
}

std::string third_title(const RunRecord& record) {
  return record.role == "edge" ? "(iii) Edge of the part" : "(iii) Contour after release";
}

std::string statistics_table(const RunRecord& record) {
  const DeviationStatistics &ii = record.as_scanned, &iii = record.pulled_back;
  const double nan = std::nan("");
  std::string rows =
      number_row({"signed deviation, mm", "(ii) as scanned", escaped(third_title(record))}, "th");
  rows += number_row({"points", grouped_text(ii.count), grouped_text(iii.count)});
  const auto add = [&](const char* name, double DeviationStatistics::*field, bool is_signed) {
    const double a = ii.count > 0 ? ii.*field : nan, b = iii.count > 0 ? iii.*field : nan;
    rows += number_row({name, is_signed ? signed_mm(a) : mm(a), is_signed ? signed_mm(b) : mm(b)});
  };
  add("lowest", &DeviationStatistics::min_mm, true);
  add("highest", &DeviationStatistics::max_mm, true);
  add("mean", &DeviationStatistics::mean_mm, true);
  add("median", &DeviationStatistics::median_mm, true);
  add("5th percentile", &DeviationStatistics::p05_mm, true);
  add("95th percentile", &DeviationStatistics::p95_mm, true);
  add("RMS about zero", &DeviationStatistics::rms_mm, false);
  add("sigma about the mean", &DeviationStatistics::sigma_mm, false);
  const Judged &j2 = record.judged_as_scanned, &j3 = record.judged_pulled_back;
  rows += number_row({"profile value, 2 max|d|", ii.count > 0 ? mm(j2.value_mm) : mm(nan),
                      iii.count > 0 ? mm(j3.value_mm) : mm(nan)});
  const auto zone = [&](double t) { return t > 0.0 ? mm(t) : "not stated"; };
  rows +=
      number_row({"tolerance, full width", zone(record.surface_profile_mm), zone(record.contour_profile_mm)});
  const auto u = [](const Judged& j) { return j.uncertainty_stated ? mm(j.uncertainty_mm) : "not stated"; };
  rows += number_row({"uncertainty U (k = 2)", u(j2), u(j3)});
  const auto share = [&](const char* name, double DeviationStatistics::*field) {
    rows += number_row({name, percent(ii.count > 0 && record.surface_profile_mm > 0.0 ? ii.*field : nan, 2),
                        percent(iii.count > 0 && record.contour_profile_mm > 0.0 ? iii.*field : nan, 2)});
  };
  share("in tolerance", &DeviationStatistics::in_tolerance_ratio);
  share("over", &DeviationStatistics::over_ratio);
  share("under", &DeviationStatistics::under_ratio);
  return tag("table", rows);
}

}  // namespace

std::string banner(const RunRecord& record) {
  std::string html = "<div class=\"top\"><div>" + tag("h1", "Part " + escaped(record.part_number)) +
                     tag("div", "Scan-to-path inspection report", "soft") + "</div>" +
                     tag("div", escaped(record.report_time), "soft") + "</div>\n";
  html += tag("div",
              card(css_of_correction(record), "Correction of the tool path", correction_word(record),
                   correction_why(record)) +
                  card(css_of(record.inspection_verdict()), "Inspection",
                       verdict_word(record.inspection_verdict()), inspection_why(record)),
              "verdicts");
  html += tag("div", tag("strong", "What to do now") + list_of("ol", next_steps(record)), "next") + "\n";
  if (!record.accepted())
    html += tag("div",
                tag("strong", "Why it is refused. No program was written.") + list_of("ul", record.refusals),
                "reasons") +
            "\n";
  else if (record.frame_refused())
    html += tag("div",
                tag("strong", "Why no program was written: the scanner's frame is not known.") +
                    list_of("ul", record.frame->reasons),
                "reasons") +
            "\n";
  return html;
}

std::string facts(const RunRecord& record) {
  std::string html = tag("h2", "What was processed");
  const Facts run = {{"part number", escaped(record.part_number)},
                     {"software", escaped(record.version)},
                     {"date of the data", escaped(record.report_time)},
                     {"state of the part", escaped(record.state)},
                     {"role of the contour", escaped(record.role)},
                     {"method", escaped(record.method)},
                     {"units", "mm; angles in degrees"},
                     {"robot program", escaped(record.program_note)}};
  const Facts points = {{"points read", grouped_text(record.points_read)},
                        {"not finite, removed", grouped_text(record.points_nonfinite)},
                        {"outliers, removed", grouped_text(record.points_outlier)},
                        {"used", grouped_text(record.points_used)},
                        {"spacing", mm(record.spacing_mm, 2) + " mm"},
                        {"noise (sigma)", mm(record.noise_sigma_mm) + " mm"},
                        {"edge offset", escaped(edge_offset_text(record.edge_offset))}};
  html += tag("div", list("Run", run) + list("Scan", points), "facts");
  html += tag("h3", "Inputs") + inputs_table(record);
  html += tag("p", "result hash: " + tag("span", escaped(record.result_hash), "mono"));
  html += tag("h3", record.accepted() ? "Alignment: scan_from_cad, file coordinates, mm"
                                      : "Alignment: scan_from_cad, mm, of a refused run: for diagnosis only");
  if (record.alignment.pairs == 0) return html + tag("p", "No alignment was reached.");
  html += matrix_table(record.alignment.scan_from_cad);
  return html + list("Quality of the alignment", alignment_facts(record));
}

std::string three_results(const RunRecord& record) {
  const bool is_free = record.state == "free";
  const Result first = {
      css_of_correction(record), "(i) Correction", correction_word(record),
      "May the corrected tool path be used?",
      record.accepted() ? correction_why(record) : "the reasons stand at the top of the page"};
  const Result second = {
      css_of(record.judged_as_scanned.verdict), "(ii) Shape as scanned",
      is_free ? verdict_word(record.judged_as_scanned.verdict) : "as clamped, not judged",
      is_free ? "Every scan point against the CAD after the rigid alignment: decides the inspection."
              : "Every scan point against the CAD after the rigid alignment: clamping included.",
      record.judged_as_scanned.text};
  const Result third = {css_of(record.judged_pulled_back.verdict), third_title(record),
                        verdict_word(record.judged_pulled_back.verdict),
                        record.role == "edge"
                            ? "The edge found in the scan against the nominal one, bending taken out."
                            : "The contour pulled back through the deformation: what it will be when the "
                              "clamps let go.",
                        record.judged_pulled_back.text};
  std::string html = tag("h2", "Three results, kept apart");
  html += tag("div", result_card(first) + result_card(second) + result_card(third), "results") + "\n";
  if (const std::string warning = permanence_warning(record); !warning.empty())
    html += tag("p", tag("strong", escaped(warning)));
  if (record.as_scanned.count + record.pulled_back.count == 0) return html;
  return html + statistics_table(record);
}

}  // namespace arris::report::html
