#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <optional>

#include "acquisition/files/read_scan.hpp"
#include "acquisition/geometry/parallel_for.hpp"
#include "acquisition/types/error.hpp"
#include "fixtures/synthetic/write.hpp"
#include "tests/bench/accuracy/special.hpp"
#include "tests/support/bench_part.hpp"
#include "tests/support/one_run.hpp"

namespace arris::bench {
namespace {

namespace fs = std::filesystem;

const Eigen::Vector3d kShiftMm(6000.0, -8000.0, 1234.5);  // 10 m
constexpr double kSameMm = 1e-3;
constexpr int kMostSeeds = 2;

/// A file that is gone when this is.
class PassingFile {
 public:
  PassingFile(const std::string& name, const std::string& bytes) : file_(fs::temp_directory_path() / name) {
    std::ofstream out(file_, std::ios::binary | std::ios::trunc);
    out << bytes;
    out.close();
    if (!out) throw Error(Fault::kInput, "cannot write " + file_.string());
  }
  PassingFile(const PassingFile&) = delete;
  PassingFile& operator=(const PassingFile&) = delete;
  ~PassingFile() {
    std::error_code ignored;
    fs::remove(file_, ignored);
  }
  [[nodiscard]] const fs::path& path() const { return file_; }

 private:
  fs::path file_;
};

/// The corrected path of a scan shifted in its file, shifted back; none when refused.
std::optional<std::vector<Eigen::Vector3d>> path_from(const BenchPart& part,
                                                      const synthetic::SyntheticScan& scan,
                                                      const Eigen::Vector3d& shift_mm,
                                                      const std::string& name) {
  const PassingFile file("arris_bench_" + part.fe.name() + name, synthetic::double_ply(scan, shift_mm, 0.0));
  const PointCloud cloud = read_scan(file.path()).cloud;
  const OneRun run =
      run_one({part.recipe, part.cad, part.drawing.path, 1}, cloud, calibrated_options(part.recipe, 1));
  if (!run.accepted()) return std::nullopt;
  RigidMotion back = RigidMotion::Identity();
  back.translation() = cloud.offset_mm - shift_mm;
  return run.tips_mm(back);
}

/// How far row i moved. Along a circle it may slide, for nothing tells its turn: there off the path's course.
double moved_mm(const std::vector<Eigen::Vector3d>& near, const std::vector<Eigen::Vector3d>& far,
                std::size_t i, bool is_circle) {
  const Eigen::Vector3d move_mm = far[i] - near[i];
  if (!is_circle) return move_mm.norm();
  const std::size_t count = near.size();
  const Eigen::Vector3d along = (near[(i + 1) % count] - near[(i + count - 1) % count]).normalized();
  return (move_mm - move_mm.dot(along) * along).norm();
}

/// The farthest that a row is from where it was; none when either was refused.
std::optional<double> most_moved_mm(const BenchPart& part, std::uint64_t seed) {
  const synthetic::SyntheticScan scan = sample_scan(part.fe, {}, seed);
  const std::string end = "_" + std::to_string(seed) + ".ply";
  const auto near = path_from(part, scan, Eigen::Vector3d::Zero(), "_near" + end);
  const auto far = path_from(part, scan, kShiftMm, "_far" + end);
  if (!near || !far) return std::nullopt;
  double worst_mm = 0.0;
  for (std::size_t i = 0; i < near->size(); ++i)
    worst_mm = std::max(worst_mm, moved_mm(*near, *far, i, part.truth.is_circle()));
  return worst_mm;
}

GoalRow far_row(const BenchPart& part, const SpecialSetup& setup) {
  GoalRow row{.what = "10 m away from the origin, file in double: greatest difference",
              .part = part.fe.name() + (part.truth.is_circle() ? ", off the circle's course" : "")};
  row.goal = fmt::format("{:.0f} micrometre", 1e3 * kSameMm);
  std::vector<std::optional<double>> moved(static_cast<std::size_t>(std::min(setup.seeds, kMostSeeds)));
  parallel_for(moved.size(), 1, setup.threads, [&](std::size_t begin, std::size_t end) {
    for (std::size_t i = begin; i < end; ++i) moved[i] = most_moved_mm(part, i + 1);
  });
  double worst_mm = 0.0, sum_mm = 0.0;
  row.scans = moved.size();
  for (const std::optional<double>& one : moved) {
    row.refused += one ? 0U : 1U;
    row.within += one && *one <= kSameMm ? 1U : 0U;
    worst_mm = std::max(worst_mm, one.value_or(0.0));
    sum_mm += one.value_or(0.0);
  }
  const bool any = row.refused < row.scans;
  row.reached =
      any ? fmt::format("{:.3f} micrometre", 1e3 * sum_mm / static_cast<double>(row.scans - row.refused))
          : "-";
  row.worst = any ? fmt::format("{:.3f} micrometre", 1e3 * worst_mm) : "-";
  row.met = row.within == row.scans;
  return row;
}

}  // namespace

std::vector<GoalRow> far_rows(const SpecialSetup& setup) {
  std::vector<GoalRow> rows;
  for (const std::string name : {"porthole", "nosecone", "sheet", "bracket", "duct"})
    rows.push_back(far_row(BenchPart(setup.fixtures / name, 1), setup));
  return rows;
}

}  // namespace arris::bench
