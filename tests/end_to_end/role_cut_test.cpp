// The tool makes the opening: the part comes without it, and the path goes where the drawing's material is.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "fixtures/synthetic/analytic_part.hpp"
#include "tests/end_to_end/job.hpp"

namespace arris {
namespace {

using synthetic::PlatePart;
using testing::Job;
using testing::Ran;

constexpr double kMeanMm = 0.3, kMaxMm = 0.8;

/// The example's plate before its opening is cut.
PlatePart uncut(bool with_datum_holes) {
  synthetic::PlateShape shape = synthetic::asymmetric_plate();
  if (with_datum_holes)
    shape.holes.erase(shape.holes.begin());
  else
    shape.holes.clear();
  return PlatePart(shape);
}

class CutJob : public Job {
 public:
  CutJob() : Job("example") { replace("recipe.toml", "role = \"edge\"", "role = \"cut\""); }

  synthetic::SyntheticScan put_uncut_scan(bool with_datum_holes, double band_mm) const {
    synthetic::ScanOptions options;
    options.points = 12000;
    options.band_mm = band_mm;
    synthetic::SyntheticScan scan = synthetic::sample_scan(uncut(with_datum_holes), options, 5);
    put_scan("uncut.ply", scan);
    return scan;
  }
};

TEST(RoleCutRun, PathGoesWhereTheMaterialIsAndTheReportJudgesNoEdge) {
  const CutJob job;
  const synthetic::SyntheticScan scan = job.put_uncut_scan(true, 0.0);
  const Ran ran = job.run("uncut.ply", "out");
  ASSERT_TRUE(ran.code == 0 || ran.code == 4) << ran.code << ran.out << ran.err;
  std::vector<synthetic::EdgePoint> truth = PlatePart(synthetic::asymmetric_plate()).edge(0, 0.5);
  for (synthetic::EdgePoint& p : truth) {
    p.true_mm = scan.scan_from_cad * p.true_mm;
    p.true_normal = scan.scan_from_cad.linear() * p.true_normal;
  }
  const testing::PathError error =
      testing::error_to(testing::read_table(job.file("out/corrected.csv")), truth);
  EXPECT_LT(error.mean_mm, kMeanMm);
  EXPECT_LT(error.max_mm, kMaxMm);
  EXPECT_LT(error.axis_mean_deg, 0.5);
  for (const char* nonsense : {"nan", "inf", "found edge"})
    EXPECT_EQ(ran.out.find(nonsense), std::string::npos) << ran.out;

  const auto result = nlohmann::json::parse(testing::text_of(job.file("out/result.json")));
  EXPECT_EQ(result.at("results").at("iii_contour_pulled_back").at("judged").at("verdict"), "NOT JUDGED");
  EXPECT_TRUE(result.at("contour_errors").at("contours").empty()) << result.at("contour_errors");
  EXPECT_NE(testing::text_of(job.file("out/report.html")).find("no edge to compare with yet"),
            std::string::npos);
  EXPECT_TRUE(result.at("limits").at("edge_limit_mm").is_null()) << result.at("limits");
  EXPECT_GT(result.at("alignment").at("overlap_ratio").get<double>(), 0.9);
}

TEST(RoleCutRun, NamesTheMotionThatNothingHolds) {
  const CutJob job;
  job.put_uncut_scan(false, 60.0);  // no datum hole, and the outline out of sight
  const Ran ran = job.run("uncut.ply", "out");
  EXPECT_EQ(ran.code, 5) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("leaves these free: "), std::string::npos) << ran.out;
  EXPECT_FALSE(std::filesystem::exists(job.file("out/program.mod")));
}

}  // namespace
}  // namespace arris
