// The main job on parts whose deformation was solved by finite elements: the real program, real files, and
// figures against the solved shape.
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>

#include "cli/cell.hpp"
#include "fixtures/synthetic/fe_part.hpp"
#include "fixtures/synthetic/write.hpp"
#include "tests/end_to_end/job.hpp"
#include "toolpath/robot/read_rapid.hpp"
#include "toolpath/robot/read_vplus.hpp"

namespace arris {
namespace {

using Eigen::Vector3d;
using testing::Job;
using testing::Ran;
using testing::Table;

constexpr double kProgramMm = 0.001;
constexpr double kAxisMeanDeg = 2.0;

struct FeCase {
  const char* part;
  double mean_mm, max_mm;  ///< distance of the corrected path from the true edge, at most
  double along_mm;         ///< and of each row from its own material point; 0: a round hole does not tell
};
std::ostream& operator<<(std::ostream& out, const FeCase& c) {
  return out << c.part;
}

/// Reads a program and says where its moves at rows are: between the first and the last stop at a clearance.
struct Moves {
  std::vector<Vector3d> tip_mm;  ///< robot frame
  std::vector<Vector3d> axis;    ///< out of the material
  bool switches = false, on_at_end = false;
};

Moves moves_of(const Reading& reading) {
  Moves moves;
  for (const ReadEvent& event : reading.events) {
    if (const auto* set = std::get_if<ReadSet>(&event)) {
      moves.switches = true;
      moves.on_at_end = set->value != 0;
    }
    const auto* move = std::get_if<ReadMove>(&event);
    if (move == nullptr) continue;
    const auto& p = move->pose.xyz_mm;
    const auto& q = move->pose.quat_wxyz;
    moves.tip_mm.emplace_back(p[0], p[1], p[2]);
    moves.axis.push_back(Eigen::Quaterniond(q[0], q[1], q[2], q[3]) * -Vector3d::UnitZ());
  }
  return moves;
}

/// Rows of one path of a table, [begin, end).
struct PathRows {
  std::size_t begin = 0, end = 0;
};

std::vector<PathRows> paths_of(const Table& table) {
  std::vector<PathRows> paths;
  for (std::size_t row = 0; row < table.rows.size(); ++row) {
    if (row == 0 || table.rows[row].at(6) != table.rows[row - 1].at(6)) paths.push_back({row, row});
    paths.back().end = row + 1;
  }
  return paths;
}

/// Path after path: clearance, every row, the first row again where the path is closed, clearance.
void expect_program(const Table& corrected, const Moves& moves, const Cell& cell, double away_mm) {
  std::size_t move = 0;
  const std::vector<PathRows> paths = paths_of(corrected);
  ASSERT_EQ(moves.tip_mm.size(), corrected.rows.size() + 3 * paths.size());
  for (const PathRows& path : paths) {
    const Vector3d first_mm = cell.robot_from_scan * corrected.tip_mm(path.begin);
    const auto expect_clear = [&] {
      EXPECT_NEAR((moves.tip_mm[move++] - first_mm).norm(), away_mm + cell.clearance_mm, 0.01);
    };
    expect_clear();
    for (std::size_t i = path.begin; i <= path.end; ++i, ++move) {
      const std::size_t row = i == path.end ? path.begin : i;
      const Vector3d axis = cell.robot_from_scan.linear() * corrected.axis(row);
      const Vector3d tip_mm = cell.robot_from_scan * corrected.tip_mm(row) + away_mm * axis;
      ASSERT_LT((moves.tip_mm[move] - tip_mm).norm(), kProgramMm) << "row " << row;
      ASSERT_LT((moves.axis[move] - axis).norm(), 1e-4) << "row " << row;
    }
    expect_clear();
  }
}

/// Each corrected row stays near the true place of its own material point: same order, same start.
void expect_same_order(const Table& nominal, const Table& corrected,
                       const std::vector<synthetic::EdgePoint>& edge, double along_mm) {
  for (std::size_t row = 0; row < nominal.rows.size(); ++row) {
    const Vector3d p_mm = nominal.tip_mm(row);
    const auto own = std::min_element(edge.begin(), edge.end(), [&](const auto& a, const auto& b) {
      return (a.nominal_mm - p_mm).norm() < (b.nominal_mm - p_mm).norm();
    });
    ASSERT_LT((corrected.tip_mm(row) - own->true_mm).norm(), along_mm) << "row " << row;
    ASSERT_EQ(corrected.rows[row].at(6), nominal.rows[row].at(6)) << "path of row " << row;
    ASSERT_EQ(corrected.rows[row].at(7), nominal.rows[row].at(7)) << "closed of row " << row;
  }
}

class FeParts : public ::testing::TestWithParam<FeCase> {};

TEST_P(FeParts, ScanBecomesCorrectedPathProgramAndReport) {
  const FeCase& fe = GetParam();
  const Job job(std::string("fe/") + fe.part);
  const synthetic::SyntheticScan scan = testing::fe_scan(fe.part, testing::usual_options(fe.part), 21);
  job.put_scan("scan.ply", scan);
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.err;
  ASSERT_EQ(job.names("out"), testing::kAcceptedFiles);

  const Table nominal = testing::read_table(job.file("path.csv"));
  const Table corrected = testing::read_table(job.file("out/corrected.csv"));
  ASSERT_EQ(corrected.rows.size(), nominal.rows.size());
  EXPECT_TRUE(corrected.header.starts_with(nominal.header + ",shift_mm")) << corrected.header;
  if (fe.along_mm > 0.0) expect_same_order(nominal, corrected, scan.edge, fe.along_mm);
  const testing::PathError error = testing::error_to(corrected, scan.edge);
  EXPECT_LT(error.mean_mm, fe.mean_mm);
  EXPECT_LT(error.max_mm, fe.max_mm);
  EXPECT_LT(error.axis_mean_deg, kAxisMeanDeg);

  const Cell cell = read_cell(job.file("cell.toml"));
  const auto read = [&](const std::string& name) {
    return moves_of(read_rapid(testing::text_of(job.file("out/" + name)), name));
  };
  const Moves program = read("program.mod"), dry = read("program_dry.mod");
  expect_program(corrected, program, cell, 0.0);
  expect_program(corrected, dry, cell, cell.dry_run_offset_mm);
  EXPECT_TRUE(program.switches);
  EXPECT_FALSE(program.on_at_end);
  EXPECT_FALSE(dry.switches);
}

/// Bounds are a few times what 20 scans reach (docs/results.md).
INSTANTIATE_TEST_SUITE_P(All, FeParts,
                         ::testing::Values(FeCase{"porthole", 0.4, 1.5, 6.0},
                                           FeCase{"nosecone", 0.5, 3.0, 6.0}, FeCase{"sheet", 0.4, 1.2, 0.0},
                                           FeCase{"bracket", 0.15, 0.5, 1.0}, FeCase{"duct", 0.35, 1.2, 3.0}),
                         [](const auto& one) { return one.param.part; });

/// The same job for a V+ controller: frames that are turned, a tool by signal number, the dry-run twin.
TEST(FePartsVplus, ProgramsAgreeWithTheCorrectedPathThroughTheCellsFrames) {
  const Job job("fe/porthole");
  job.replace("recipe.toml", "controller = \"rapid\"", "controller = \"vplus\"");
  job.put_scan("scan.ply", testing::fe_scan("porthole", testing::usual_options("porthole"), 21));
  const Ran by_name = job.run("scan.ply", "out");  // the lines of the part's own cell are RAPID's
  EXPECT_EQ(by_name.code, 3);
  EXPECT_NE(by_name.err.find("need for V+ the number of a digital signal"), std::string::npos) << by_name.err;
  EXPECT_FALSE(job.names().contains("out"));
  job.put("cell.toml",
          "[frames]\n"
          "robot_from_scan = { xyz_mm = [850.0, -20.0, 400.0], quat_wxyz = [0.8, 0.0, 0.6, 0.0] }\n"
          "robot_from_work = { xyz_mm = [800.0, 10.0, 390.0], quat_wxyz = [0.6, 0.0, 0.0, 0.8] }\n"
          "[robot]\nspindle_output = \"97\"\nspindle_ready = \"1097\"\nmax_points = 100\n");
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.err;
  ASSERT_FALSE(job.names("out").contains("program.mod"));

  const Table corrected = testing::read_table(job.file("out/corrected.csv"));
  const Cell cell = read_cell(job.file("cell.toml"));
  for (const bool dry_run : {false, true}) {
    const std::string name = dry_run ? "program_dry.v2" : "program.v2";
    const Reading reading = read_vplus(testing::text_of(job.file("out/" + name)), name);
    EXPECT_NE(corrected.comment.find(reading.result_hash), std::string::npos);
    ASSERT_EQ(reading.works.count(cell.work_name), 1u);
    Moves moves = moves_of(reading);
    for (Vector3d& tip_mm : moves.tip_mm) tip_mm = cell.robot_from_work * tip_mm;
    for (Vector3d& axis : moves.axis) axis = cell.robot_from_work.linear() * axis;
    expect_program(corrected, moves, cell, dry_run ? cell.dry_run_offset_mm : 0.0);
    EXPECT_EQ(moves.switches, !dry_run);
    EXPECT_FALSE(moves.on_at_end);
  }
}

/// Walls of the cut, strays and missing patches, as a hand scanner brings them.
TEST(FePartsDirty, WallsStraysAndGapsStillGiveAPath) {
  const Job job("fe/porthole");
  synthetic::ScanOptions options = testing::usual_options("porthole");
  options.missing_ratio = 0.1;
  options.stray_ratio = 0.01;
  options.wall_ratio = 0.05;
  options.density_variation_ratio = 2.0;
  const synthetic::SyntheticScan scan = testing::fe_scan("porthole", options, 23);
  job.put_scan("scan.ply", scan);
  const Ran ran = job.run("scan.ply", "out");
  ASSERT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.out << ran.err;
  const testing::PathError error =
      testing::error_to(testing::read_table(job.file("out/corrected.csv")), scan.edge);
  EXPECT_LT(error.mean_mm, 0.6);
  EXPECT_LT(error.max_mm, 3.0);
}

/// Two slots in a row, their ends partly missing from the scan: some millimetres along they look alike. Scan
/// 9 was once accepted 9 mm off, its slots' ends taken for gaps; so was scan 36, where as much is seen
/// elsewhere but less lies beyond the edges.
class SlidSlot : public ::testing::TestWithParam<int> {};
TEST_P(SlidSlot, IsRefusedOrRight) {
  const Job job("fe/duct");
  synthetic::ScanOptions options;
  options.missing_ratio = 0.15;
  options.stray_ratio = 0.05;
  options.wall_ratio = 0.03;
  options.density_variation_ratio = 2.0;
  const synthetic::SyntheticScan scan = testing::fe_scan("duct", options, GetParam());
  job.put_scan("scan.ply", scan);
  const Ran ran = job.run("scan.ply", "out");
  if (ran.code == 5) {
    EXPECT_NE(ran.out.find("seen much better with the part moved"), std::string::npos) << ran.out;
    EXPECT_FALSE(std::filesystem::exists(job.file("out/program.mod")));
    return;
  }
  ASSERT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.out << ran.err;
  EXPECT_LT(testing::error_to(testing::read_table(job.file("out/corrected.csv")), scan.edge).mean_mm, 0.5);
}
INSTANTIATE_TEST_SUITE_P(FePartsDirty, SlidSlot, ::testing::Values(9, 36));

/// A scan that is triangles: the deformed face as a hand scanner's software exports it.
TEST(MeshScan, StlRunsToAnAcceptedPath) {
  const Job job("fe/porthole");
  synthetic::ScanOptions options;
  const synthetic::FePart part =
      synthetic::load_fe_part(std::filesystem::path(ARRIS_SOURCE_DIR) / "fixtures/fe/porthole");
  const synthetic::MeshScan scan = synthetic::sample_mesh_scan(part, options, 3.0, 24);
  synthetic::write_mesh(job.file("scan.stl"), scan.mesh, "a scan");
  const Ran ran = job.run("scan.stl", "out");
  ASSERT_TRUE(ran.code == 0 || ran.code == 4 || ran.code == 7) << ran.code << ran.out << ran.err;
  EXPECT_NE(ran.out.find("ACCEPTED"), std::string::npos) << ran.out;
  const testing::PathError error =
      testing::error_to(testing::read_table(job.file("out/corrected.csv")), scan.truth.edge);
  EXPECT_LT(error.mean_mm, 0.4);
  EXPECT_LT(error.max_mm, 1.5);
  EXPECT_LT(error.axis_mean_deg, kAxisMeanDeg);
}

}  // namespace
}  // namespace arris
