// A scanner that shows edges too far out, or too far in: measured on a gauge, taken off a part.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "fixtures/synthetic/analytic_part.hpp"
#include "fixtures/synthetic/write.hpp"
#include "tests/end_to_end/job.hpp"

namespace arris {
namespace {

using nlohmann::json;
using synthetic::PlatePart;
using synthetic::PlateShape;
using testing::Job;
using testing::Ran;
using testing::text_of;

constexpr double kUncalibratedSdMm = 0.05;

/// The material larger all round by out_mm: what a scanner of that offset makes of a plate.
PlateShape shown(PlateShape shape, double out_mm) {
  shape.half_x_mm += out_mm;
  shape.half_y_mm += out_mm;
  for (synthetic::PlateHole& hole : shape.holes) {
    hole.half_x_mm -= out_mm;
    hole.half_y_mm -= out_mm;
    hole.corner_radius_mm -= out_mm;
  }
  return shape;
}

/// A stiff plate with two round holes of known size.
PlateShape gauge() {
  PlateShape shape;
  shape.half_x_mm = 120.0;
  shape.half_y_mm = 90.0;
  shape.holes.push_back({{-50.0, 10.0}, 40.0, 40.0, 40.0, 0.0});
  shape.holes.push_back({{45.0, 10.0}, 25.0, 25.0, 25.0, 0.0});
  return shape;
}

/// The example's plate with an opening that was moulded 0.2 mm too large all round: the part's own error.
PlateShape real_part() {
  PlateShape shape = synthetic::asymmetric_plate();
  shape.holes.front() = shown(shape, -0.2).holes.front();
  return shape;
}

synthetic::SyntheticScan whole_face(const PlateShape& shape, std::int64_t points, std::uint64_t seed) {
  synthetic::ScanOptions options;
  options.band_mm = 0.0;
  options.points = points;
  return synthetic::sample_scan(PlatePart(shape), options, seed);
}

/// The example's part beside a gauge with its recipe, both seen by one scanner.
class ScannerJob : public Job {
 public:
  explicit ScannerJob(double out_mm) : Job("example"), out_mm_(out_mm) {
    synthetic::write_mesh(file("gauge.stl"), PlatePart(gauge()).cad_mesh(8.0), "gauge");
    put("gauge.toml",
        "schema = 1\n[part]\nnumber = \"gauge\"\ncad = \"gauge.stl\"\ncad_units = \"mm\"\n"
        "[scan]\nunits = \"mm\"\n[contour]\naccept = [1, 2, 3]\n");
    for (int i = 1; i <= 2; ++i) put_gauge_scan("g" + std::to_string(i) + ".ply", gauge(), 40000, 10 + i);
    scan_ = whole_face(shown(real_part(), out_mm), 30000, 21);
    put_scan("part.ply", scan_);
  }

  void put_gauge_scan(const std::string& name, const PlateShape& shape, std::int64_t points, int seed) const {
    put_scan(name, whole_face(shown(shape, out_mm_), points, static_cast<std::uint64_t>(seed)));
  }

  [[nodiscard]] Ran calibrate(const std::string& more = "",
                              const std::string& scans = "g1.ply g2.ply") const {
    return arris("calibrate edge gauge.toml --scan " + scans + " --scanner 'Hall 2' --out edge.toml " + more);
  }

  /// From here on the part's recipe knows the scanner.
  void use_calibration() const {
    replace("recipe.toml", "[scan]\n", "[scan]\nedge_calibration = \"edge.toml\"\n");
  }

  [[nodiscard]] std::vector<synthetic::EdgePoint> true_edge() const {
    std::vector<synthetic::EdgePoint> truth = PlatePart(real_part()).edge(0, 0.5);
    for (synthetic::EdgePoint& p : truth) {
      p.true_mm = scan_.scan_from_cad * p.true_mm;
      p.true_normal = scan_.scan_from_cad.linear() * p.true_normal;
    }
    return truth;
  }

 private:
  double out_mm_;
  synthetic::SyntheticScan scan_;
};

/// Accepted, whatever the inspection says.
bool accepted(const Ran& ran) {
  return ran.code == 0 || ran.code == 4 || ran.code == 7;
}

json result_of(const Job& job, const std::string& out) {
  return json::parse(text_of(job.file(out + "/result.json")));
}

std::size_t column(const testing::Table& path, const std::string& name) {
  const std::string before = path.header.substr(0, path.header.find(name));
  return static_cast<std::size_t>(std::count(before.begin(), before.end(), ','));
}

std::vector<double> numbers(const testing::Table& path, const std::string& name) {
  std::vector<double> values;
  for (const auto& row : path.rows) values.push_back(std::stod(row.at(column(path, name))));
  return values;
}

/// Share of the rows within two standard deviations of the true edge.
double covered_ratio(const testing::Table& path, const std::vector<synthetic::EdgePoint>& truth) {
  const std::vector<double> across = numbers(path, "sd_across_mm"), normal = numbers(path, "sd_normal_mm");
  double covered = 0.0;
  for (std::size_t i = 0; i < path.rows.size(); ++i) {
    const testing::Table row{path.comment, path.header, {path.rows[i]}};
    if (testing::error_to(row, truth).max_mm <= 2.0 * std::hypot(across[i], normal[i])) covered += 1.0;
  }
  return covered / static_cast<double>(path.rows.size());
}

TEST(CalibrateEdge, ThenThePathFollowsTheRealEdgeForEitherSign) {
  for (const double out_mm : {-0.25, 0.2}) {
    const ScannerJob job(out_mm);
    ASSERT_TRUE(accepted(job.run("part.ply", "before")));
    const Ran calibrated = job.calibrate("--serial 0042");
    ASSERT_EQ(calibrated.code, 0) << calibrated.out << calibrated.err;
    job.use_calibration();
    const Ran ran = job.run("part.ply", "after");
    ASSERT_TRUE(accepted(ran)) << ran.out << ran.err;

    const auto truth = job.true_edge();
    const testing::Table before = testing::read_table(job.file("before/corrected.csv"));
    const testing::Table after = testing::read_table(job.file("after/corrected.csv"));
    EXPECT_NEAR(testing::error_to(before, truth).mean_mm, std::abs(out_mm), 0.04) << out_mm;
    EXPECT_LT(testing::error_to(after, truth).mean_mm, 0.05) << out_mm;
    EXPECT_LT(testing::error_to(after, truth).max_mm, 0.12) << out_mm;
    EXPECT_GT(covered_ratio(after, truth), 0.9) << out_mm;

    const json offset = result_of(job, "after").at("limits").at("edge_offset");
    EXPECT_NEAR(offset.at("out_mm").get<double>(), out_mm, 0.04);
    EXPECT_EQ(offset.at("scanner"), "Hall 2");
    EXPECT_NE(ran.out.find("edge offset  calibrated 20"), std::string::npos) << ran.out;
    EXPECT_NE(text_of(job.file("after/report.html")).find("scanner Hall 2 (0042)"), std::string::npos);
  }
}

TEST(CalibrateEdge, WithoutItNoEdgeIsKnownBetterThanTheFloor) {
  const ScannerJob job(0.07);
  const Ran ran = job.run("part.ply", "out");
  const testing::Table path = testing::read_table(job.file("out/corrected.csv"));
  for (const double sd_mm : numbers(path, "sd_across_mm")) EXPECT_GT(sd_mm, kUncalibratedSdMm);
  EXPECT_GT(covered_ratio(path, job.true_edge()), 0.9) << "an offset that scanners have";
  EXPECT_NE(ran.out.find("edge offset  not calibrated, \u00b10.05 mm assumed"), std::string::npos) << ran.out;
  EXPECT_NE(text_of(job.file("out/report.html")).find("not calibrated"), std::string::npos);
  EXPECT_EQ(result_of(job, "out").at("limits").at("edge_offset").at("calibrated"), false);
  EXPECT_EQ(result_of(job, "out").at("limits").at("edge_offset").at("scanner"), nullptr);
}

TEST(CalibrateEdge, RefusesAReferenceThatIsNotAsDrawnAndWritesNothing) {
  const ScannerJob job(0.0);
  PlateShape bent = gauge(), bored = gauge();
  bent.bend_curvature_per_mm = 1.0 / 3000.0;
  bored.holes.front() = shown(gauge(), -0.3).holes.front();
  job.put_gauge_scan("bent.ply", bent, 40000, 3);
  job.put_gauge_scan("bored.ply", bored, 60000, 4);
  job.put_gauge_scan("coarse.ply", gauge(), 3000, 5);
  for (const auto& [scan, reason] :
       {std::pair("bent.ply", "bent"), {"bored.ply", "size"}, {"coarse.ply", "scan more densely"}}) {
    const Ran ran = job.calibrate("", scan);
    EXPECT_EQ(ran.code, 5) << scan << ran.out << ran.err;
    EXPECT_NE(ran.out.find(reason), std::string::npos) << ran.out;
    const json told = json::parse(job.calibrate("--json", scan).out);
    EXPECT_EQ(told.at("calibrated"), false);
    EXPECT_EQ(told.at("edge"), nullptr);
    EXPECT_FALSE(job.names().contains("edge.toml")) << scan;
  }
  const Ran other = job.calibrate("", "part.ply");
  EXPECT_EQ(other.code, 5) << other.out << other.err;
  EXPECT_NE(other.out.find("part.ply: "), std::string::npos) << other.out;
}

TEST(CalibrateEdge, OverwritesNothingButAFormerCalibrationWhenAsked) {
  const ScannerJob job(0.0);
  ASSERT_EQ(job.calibrate().code, 0);
  const std::string first = text_of(job.file("edge.toml"));
  EXPECT_EQ(job.calibrate().code, 3);
  EXPECT_EQ(job.calibrate("--force", "g2.ply").code, 0);
  const std::string second = text_of(job.file("edge.toml"));
  EXPECT_NE(first, second) << "of one scan instead of two";
  ASSERT_EQ(job.calibrate("--force", "g2.ply --threads 1").code, 0);
  EXPECT_EQ(text_of(job.file("edge.toml")), second) << "the same bytes for any number of threads";
  EXPECT_EQ(job.calibrate("--force", "g1.ply g2.ply g1.ply").code, 3) << "one scan twice";
  EXPECT_EQ(text_of(job.file("edge.toml")), second);
  const std::string recipe = text_of(job.file("gauge.toml"));
  EXPECT_EQ(job.calibrate("--force --out gauge.toml").code, 2) << "--out twice";
  const Ran onto_recipe =
      job.arris("calibrate edge gauge.toml --scan g1.ply --scanner A --force --out gauge.toml");
  EXPECT_EQ(onto_recipe.code, 3);
  EXPECT_EQ(text_of(job.file("gauge.toml")), recipe);
}

TEST(CalibrateEdge, IsAnInputOfTheRunAndOfABatch) {
  const ScannerJob job(0.1);
  ASSERT_EQ(job.calibrate().code, 0);
  job.use_calibration();
  const auto hash = [&](const std::string& out) {
    EXPECT_NE(job.run("part.ply", out).code, 3);
    return result_of(job, out).at("result_hash").get<std::string>();
  };
  ASSERT_TRUE(accepted(job.arris("batch recipe.toml part.ply --out many")));
  const std::string first = hash("first");
  EXPECT_EQ(hash("again"), first);
  EXPECT_EQ(result_of(job, "many/part").at("result_hash"), first);
  job.put("edge.toml", text_of(job.file("edge.toml")) + "#\n");
  const std::string changed = hash("changed");
  EXPECT_NE(changed, first);
  ASSERT_TRUE(accepted(job.arris("batch recipe.toml part.ply --out many")));
  EXPECT_EQ(result_of(job, "many/part").at("result_hash"), changed) << "run again, for its inputs changed";
  const json result = result_of(job, "first");
  bool listed = false;
  for (const json& input : result.at("inputs")) listed |= input.at("role") == "edge_calibration";
  EXPECT_TRUE(listed);
}

TEST(CalibrateEdge, BadFilesAreNamedByCheckRunAndBatch) {
  const ScannerJob job(0.0);
  job.use_calibration();
  for (const char* text : {"", "schema = 1\n[edge]\nout_mm = 1e300\n", "\x01\x02", "[edge\n"}) {
    job.put("edge.toml", text);
    for (const char* line : {"recipe check recipe.toml", "run recipe.toml --scan part.ply --out out",
                             "batch recipe.toml part.ply --out many"}) {
      const Ran ran = job.arris(line);
      EXPECT_EQ(ran.code, 3) << line << ran.out << ran.err;
      EXPECT_NE(ran.err.find("edge.toml"), std::string::npos) << ran.err;
      EXPECT_NE(ran.err.find("next: write it again: arris calibrate edge"), std::string::npos) << ran.err;
    }
    EXPECT_FALSE(job.names().contains("out"));
  }
  std::filesystem::remove(job.file("edge.toml"));
  EXPECT_EQ(job.run("part.ply", "out").code, 3);
  EXPECT_NE(job.arris("recipe check recipe.toml").err.find("scan.edge_calibration"), std::string::npos);
}

}  // namespace
}  // namespace arris
