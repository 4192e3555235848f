#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <set>

#include "report/html_text.hpp"
#include "report/svg_chart.hpp"
#include "report/worst_points.hpp"
#include "report/write_html.hpp"
#include "sample_record.hpp"

namespace arris::report {
namespace {

// Tags must nest; attributes must be quoted; nothing but the known void elements may stay open.
std::string fault_of(const std::string& html) {
  const std::set<std::string> kVoid = {"meta", "img", "br", "hr", "link", "input"};
  std::vector<std::string> open;
  for (std::size_t at = 0; (at = html.find('<', at)) != std::string::npos;) {
    if (html.compare(at, 2, "<!") == 0) {
      at = html.find('>', at);
      continue;
    }
    const bool closing = html[at + 1] == '/';
    std::size_t end = at + (closing ? 2 : 1);
    std::string name;
    while (end < html.size() && (std::isalnum(static_cast<unsigned char>(html[end])) != 0))
      name += html[end++];
    if (name.empty()) return "a bare < at " + std::to_string(at);
    for (char quote = 0; end < html.size() && (quote != 0 || html[end] != '>'); ++end) {
      if (html[end] == '"') quote = quote == 0 ? '"' : '\0';
      if (html[end] == '<') return "< inside the tag " + name;
    }
    if (end >= html.size()) return "the tag " + name + " does not end";
    const bool alone = html[end - 1] == '/' || kVoid.count(name) > 0;
    if (closing) {
      if (open.empty() || open.back() != name)
        return "</" + name + "> closes " + (open.empty() ? "nothing" : open.back());
      open.pop_back();
    } else if (!alone) {
      open.push_back(name);
    }
    at = end;
    if (!closing && (name == "style" || name == "script")) at = html.find("</" + name, at);
  }
  return open.empty() ? "" : "<" + open.back() + "> is not closed";
}

bool has(const std::string& text, const std::string& part) {
  return text.find(part) != std::string::npos;
}

TEST(HtmlChecker, Bites) {
  EXPECT_EQ(fault_of("<p class=\"a\">x<br></p>"), "");
  EXPECT_NE(fault_of("<p><b>x</p></b>"), "");
  EXPECT_NE(fault_of("<p>1 < 2</p>"), "");
  EXPECT_NE(fault_of("<div>"), "");
}

TEST(WriteHtml, WellFormedAndOffline) {
  for (const RunRecord& record :
       {test::sample_record(), test::refused_record(), test::barely_started_record(), RunRecord{}}) {
    const std::string html = write_html(record);
    EXPECT_EQ(fault_of(html), "");
    for (const char* outside : {"http://", "https://", "url(", "@import", "src=\"/", "href="})
      EXPECT_FALSE(has(html, outside)) << outside;
    EXPECT_FALSE(has(html, ">nan")) << "a number that is not known must read as a dash";
  }
}

TEST(WriteHtml, SameBytesTwice) {
  EXPECT_EQ(write_html(test::sample_record()), write_html(test::sample_record()));
}

TEST(WriteHtml, EscapesWhatComesFromOutside) {
  RunRecord record = test::sample_record();
  const std::string evil = "<script>alert(\"1\")</script>&'\x01\xC3";
  record.part_number = record.version = record.report_time = record.method = record.program_note = evil;
  record.notes = {evil};
  record.refusals = {evil};
  record.inputs[0].name = record.inputs[0].role = record.inputs[0].sha256 = evil;
  record.alignment.side_decided_by = record.alignment.start = evil;
  record.alignment.free_directions = {evil};
  record.segments[0].stop = record.contour_errors[0].contour = record.stage_residual_mm[0].first = evil;
  record.refinement.statement = record.refinement.rounds[0].termination = evil;
  record.judged_as_scanned.text = record.judged_pulled_back.text = evil;
  const std::string html = write_html(record);
  EXPECT_FALSE(has(html, "<script>alert"));
  EXPECT_EQ(fault_of(html), "");
  EXPECT_TRUE(
      has(html, "&lt;script&gt;alert(&quot;1&quot;)&lt;/script&gt;&amp;&#39;\xEF\xBF\xBD\xEF\xBF\xBD"));
}

TEST(WriteHtml, HoldsTheThreeResultsAndTheFlags) {
  const RunRecord record = test::sample_record();
  const std::string html = write_html(record);
  for (const std::string& part :
       {std::string("(i) Correction"), std::string("(ii) Shape as scanned"),
        std::string("(iii) Edge of the part"), std::string("as clamped, not judged"), record.result_hash,
        std::string("ACCEPTED"), std::string("INDETERMINATE")})
    EXPECT_TRUE(has(html, part)) << part;
  for (const WorstPoint& point : worst_points(record))
    EXPECT_TRUE(has(html, "<strong>" + point.id + "</strong>"));
}

TEST(WriteHtml, ProjectionTellsItsModelAndWhatItLeaves) {
  RunRecord record = test::sample_record();
  EXPECT_FALSE(has(write_html(record), "<h3>Projection</h3>"));
  record.method = "projection";
  record.projection.resize(1);
  record.projection[0].model = "parabola";
  record.projection[0].across_rms_mm = 0.321;
  EXPECT_FALSE(has(write_html(record), "an axis through"));
  record.projection[0].bending = {-4e-4, 1e-6, 0.01, {1.0, 2.0, 3.0}, {0.0, 1.0, 0.0}};
  const std::string html = write_html(record);
  EXPECT_EQ(fault_of(html), "");
  for (const char* part :
       {"<h3>Projection</h3>", "parabola", "0.321", "1250 mm, about an axis", "1.00, 2.00, 3.00"})
    EXPECT_TRUE(has(html, part)) << part;
}

TEST(WriteHtml, RefusedRunsGiveReasonsAndNoPath) {
  const RunRecord record = test::refused_record();
  const std::string html = write_html(record);
  EXPECT_TRUE(has(html, "REFUSED"));
  EXPECT_TRUE(has(html, "No program was written"));
  for (const std::string& reason : record.refusals) EXPECT_TRUE(has(html, escaped(reason)));
  EXPECT_FALSE(has(html, "nominal and corrected tool path"));
  EXPECT_TRUE(has(write_html(test::sample_record()), "nominal and corrected tool path"));
}

TEST(Base64, KnownValues) {
  EXPECT_EQ(base64(""), "");
  EXPECT_EQ(base64("f"), "Zg==");
  EXPECT_EQ(base64("fo"), "Zm8=");
  EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(base64("\xFF\xFE"), "//4=");
}

TEST(Escaped, Utf8IsKeptOrMended) {
  EXPECT_EQ(escaped("\xC3\xA9\xE2\x88\x92"), "\xC3\xA9\xE2\x88\x92");
  EXPECT_EQ(escaped("\xED\xA0\x80"), "\xEF\xBF\xBD\xEF\xBF\xBD\xEF\xBF\xBD");  // a surrogate
  EXPECT_EQ(escaped("\xC0\xAF"), "\xEF\xBF\xBD\xEF\xBF\xBD");                  // overlong
  EXPECT_EQ(escaped("a\tb"), "a\tb");
}

TEST(LineChart, GapsBreakTheLineAndAreShaded) {
  const double gap = std::nan("");
  LineChart chart;
  chart.x = {0, 1, 2, 3, 4, 5};
  chart.x_label = "x";
  chart.y_label = "y";
  chart.series = {{"a", {1, 2, 3}, 2.0, false, {1, 2, gap, gap, 1, 2}}};
  chart.bands = {{"gap", {200, 200, 200}, spans_where(chart.x, {false, false, true, true, false, false})}};
  EXPECT_EQ(chart.bands[0].spans, (std::vector<std::pair<double, double>>{{1.5, 3.5}}));
  const std::string svg = line_chart(chart);
  EXPECT_EQ(fault_of(svg), "");
  std::size_t lines = 0;
  for (std::size_t at = 0; (at = svg.find("<polyline", at)) != std::string::npos; ++at) ++lines;
  EXPECT_EQ(lines, 2U);
  EXPECT_TRUE(has(svg, "data-y=\"1.0000 2.0000 - - 1.0000 2.0000\""));
  EXPECT_EQ(line_chart(LineChart{}), "");
}

TEST(LineChart, LongSeriesKeepTheirPeaks) {
  LineChart chart;
  for (int i = 0; i < 100000; ++i) chart.x.push_back(i);
  ChartSeries series{"a", {1, 2, 3}, 2.0, false, std::vector<double>(100000, 1.0)};
  series.y[54321] = 9.0;
  chart.series = {series};
  const std::string svg = line_chart(chart);
  EXPECT_LT(svg.size(), 200000U);
  // The peak, 9 of an axis that ends at 10, is drawn: y = 44 + (250 - 44) / 10.
  EXPECT_TRUE(has(svg, ",64.6 ")) << svg.substr(0, 3000);
}

}  // namespace
}  // namespace arris::report
