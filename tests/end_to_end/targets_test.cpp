// A hand scanner: its frame changes with every scan, and the fixture's spheres tell where it was.
#include <gtest/gtest.h>

#include <cmath>
#include <nlohmann/json.hpp>

#include "fixtures/synthetic/fe_part.hpp"
#include "fixtures/synthetic/target_scan.hpp"
#include "fixtures/synthetic/write.hpp"
#include "tests/end_to_end/job.hpp"
#include "toolpath/robot/read_rapid.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using testing::Job;
using testing::Ran;
using Json = nlohmann::json;

const char kCell[] = "[frames]\nscan_reference = \"targets\"\nreferences = \"fixture_targets.csv\"\n";

RigidMotion frame_of(double turn_rad, const Vector3d& axis, const Vector3d& shift_mm) {
  return RigidMotion(Eigen::Translation3d(shift_mm) * Eigen::AngleAxisd(turn_rad, axis.normalized()));
}
const RigidMotion kFirst = frame_of(0.7, {0.3, -0.2, 1.0}, {120.0, -60.0, 250.0});
const RigidMotion kSecond = frame_of(2.9, {-1.0, 0.4, 0.2}, {-300.0, 410.0, -90.0});

/// The sheet on its fixture, with a cell that knows the fixture's spheres.
class HandScanner : public ::testing::Test {
 protected:
  HandScanner() : job("fe/sheet") {
    job.put("cell.toml", kCell);
    synthetic::write_targets_csv(job.file("fixture_targets.csv"), targets);
  }

  [[nodiscard]] synthetic::SyntheticScan part_scan(const RigidMotion& scan_from_cad,
                                                   std::uint64_t seed) const {
    synthetic::ScanOptions options = testing::usual_options("sheet");
    options.scan_from_cad = scan_from_cad;
    return synthetic::sample_scan(part, options, seed);
  }
  /// The same with the spheres that are `shown`.
  [[nodiscard]] synthetic::SyntheticScan scan(const RigidMotion& scan_from_cad, std::uint64_t seed,
                                              const std::vector<FixtureTarget>& shown,
                                              std::uint64_t target_seed) const {
    synthetic::SyntheticScan out = part_scan(scan_from_cad, seed);
    synthetic::add_targets(out, shown, robot_from_cad, {}, target_seed);
    return out;
  }
  [[nodiscard]] Json result(const std::string& out) const {
    return Json::parse(testing::text_of(job.file(out + "/result.json")));
  }
  [[nodiscard]] std::vector<Vector3d> tips_mm(const std::string& out) const {
    std::vector<Vector3d> tips;
    for (const ReadEvent& event :
         read_rapid(testing::text_of(job.file(out + "/program.mod")), "program.mod").events)
      if (const auto* move = std::get_if<ReadMove>(&event))
        tips.emplace_back(move->pose.xyz_mm[0], move->pose.xyz_mm[1], move->pose.xyz_mm[2]);
    return tips;
  }
  /// Runs a scan to a program; the exit code may be any of a judged part.
  void run_good(const std::string& name, const synthetic::SyntheticScan& scan) const {
    job.put_scan(name + ".ply", scan);
    const Ran ran = job.run(name + ".ply", name);
    ASSERT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.out << ran.err;
    ASSERT_NE(ran.out.find("frame        SOLVED from 4 of 4"), std::string::npos) << ran.out;
    ASSERT_EQ(job.names(name), testing::kAcceptedFiles);
  }

  const synthetic::FePart part =
      synthetic::load_fe_part(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/fe/sheet");
  const RigidMotion robot_from_cad = synthetic::example_robot_from_cad();
  const std::vector<FixtureTarget> targets = synthetic::fixture_round(part, robot_from_cad);
  const Job job;
};

TEST_F(HandScanner, ProgramStaysWhereverTheScannerStood) {
  // the same points of the part seen from two places, the spheres measured anew: only the frames differ
  run_good("first", scan(kFirst, 31, targets, 32));
  run_good("second", scan(kSecond, 31, targets, 33));
  const std::vector<Vector3d> first = tips_mm("first"), second = tips_mm("second");
  ASSERT_EQ(first.size(), second.size());
  const Json sd_first = result("first")["cell"]["row_sd_robot_mm"];
  const Json sd_second = result("second")["cell"]["row_sd_robot_mm"];
  ASSERT_EQ(sd_first.size() + 3, first.size());  // clearance, the start again, clearance
  double worst_mm = 0.0;
  for (std::size_t row = 0; row < sd_first.size(); ++row) {
    const double sd_mm =
        std::hypot(sd_first[row]["frame"].get<double>(), sd_second[row]["frame"].get<double>());
    const double apart_mm = (first[row + 1] - second[row + 1]).norm();
    ASSERT_LT(apart_mm, 4.0 * sd_mm) << "row " << row;
    worst_mm = std::max(worst_mm, apart_mm);
  }
  EXPECT_LT(worst_mm, 0.1);
  EXPECT_GT(worst_mm, 1e-4);  // they are two measurements
}

TEST_F(HandScanner, FrameIsTheTrueOneWithinWhatIsStated) {
  run_good("out", scan(kFirst, 31, targets, 34));
  const Json cell = result("out")["cell"];
  RigidMotion found = RigidMotion::Identity();
  for (int row = 0; row < 3; ++row)
    for (int col = 0; col < 4; ++col)
      found.matrix()(row, col) = cell["robot_from_scan"][row][col].get<double>();
  const RigidMotion off = found * kFirst * robot_from_cad.inverse();  // robot from robot
  Eigen::Matrix<double, 6, 6> covariance;
  for (int i = 0; i < 36; ++i) covariance(i / 6, i % 6) = cell["covariance_6x6"][i].get<double>();
  const Vector3d pivot(cell["pivot_robot_mm"][0], cell["pivot_robot_mm"][1], cell["pivot_robot_mm"][2]);
  const Eigen::AngleAxisd turn(off.linear());
  Eigen::Matrix<double, 6, 1> error;
  error << turn.angle() * turn.axis(), off * pivot - pivot;
  EXPECT_LT(error.dot(covariance.ldlt().solve(error)), 22.5);  // chi squared, 6 degrees of freedom, 0.1 %
}

TEST_F(HandScanner, TargetsTakeNoPartInThePart) {
  // with and without spheres: the same correction but for float rounding about another offset
  run_good("with", scan(kFirst, 31, targets, 32));
  synthetic::SyntheticScan bare = part_scan(kFirst, 31);
  job.put_scan("bare.ply", bare);
  ASSERT_EQ(job.run("bare.ply", "bare").code, 5);
  const Json with = result("with"), without = result("bare");
  const int on_targets = static_cast<int>(with["acquisition"]["points_read"].get<double>() -
                                          without["acquisition"]["points_read"].get<double>());
  EXPECT_GT(on_targets, 1000);
  const testing::Table a = testing::read_table(job.file("with/corrected.csv"));
  const testing::Table b = testing::read_table(job.file("bare/corrected.csv"));
  ASSERT_EQ(a.rows.size(), b.rows.size());
  for (std::size_t row = 0; row < a.rows.size(); ++row)
    ASSERT_LT((a.tip_mm(row) - b.tip_mm(row)).norm(), 0.02) << row;
}

TEST_F(HandScanner, WithoutTargetsThereIsAPathAndNoProgram) {
  job.put_scan("scan.ply", part_scan(kFirst, 31));
  const Ran ran = job.run("scan.ply", "out");
  EXPECT_EQ(ran.code, 5) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("correction   ACCEPTED"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("no fixture target was found"), std::string::npos) << ran.out;
  const auto files = job.names("out");
  EXPECT_TRUE(files.contains("corrected.csv"));
  EXPECT_FALSE(files.contains("program.mod"));
  EXPECT_EQ(result("out")["verdicts"]["correction"], "ACCEPTED");
  EXPECT_EQ(result("out")["verdicts"]["exit_code"], 5);
  EXPECT_FALSE(result("out")["cell"]["solved"].get<bool>());
}

TEST_F(HandScanner, AMovedTargetIsNamedAndNoProgramIsWritten) {
  auto moved = targets;
  moved[2].place_mm += Vector3d(0.8, -0.6, 0.0);
  job.put_scan("scan.ply", scan(kSecond, 31, moved, 35));
  const Ran ran = job.run("scan.ply", "out");
  EXPECT_EQ(ran.code, 5) << ran.out << ran.err;
  EXPECT_NE(ran.out.find("correction   ACCEPTED"), std::string::npos) << ran.out;
  EXPECT_NE(ran.out.find("fixture target C is "), std::string::npos) << ran.out;
  EXPECT_FALSE(job.names("out").contains("program.mod"));
  const std::string page = testing::text_of(job.file("out/report.html"));
  EXPECT_NE(page.find("fixture target C is "), std::string::npos);
}

TEST_F(HandScanner, PointsBesideTheScanServeAsTargets) {
  auto points = targets;
  std::string side = "x,y,z,sd_mm\n";
  const synthetic::SyntheticScan bare = part_scan(kSecond, 31);
  for (FixtureTarget& target : points) {
    target.kind = TargetKind::kPoint;
    const Vector3d p = synthetic::target_in_scan_mm(bare, target, robot_from_cad);
    side += std::to_string(p.x()) + "," + std::to_string(p.y()) + "," + std::to_string(p.z()) + ",0.02\n";
  }
  synthetic::write_targets_csv(job.file("fixture_targets.csv"), points);
  job.put("markers.csv", side);
  job.put_scan("scan.ply", bare);
  const Ran ran = job.run("scan.ply", "out", "--targets markers.csv");
  EXPECT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.out << ran.err;
  EXPECT_TRUE(job.names("out").contains("program.mod"));
  const Ran mounted = job.arris("run recipe.toml --scan scan.ply --out no --targets nowhere.csv");
  EXPECT_EQ(mounted.code, 3);
}

}  // namespace
}  // namespace arris
