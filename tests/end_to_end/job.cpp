#include "tests/end_to_end/job.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <numbers>
#include <sstream>

#include "fixtures/synthetic/fe_part.hpp"
#include "fixtures/synthetic/write.hpp"

namespace arris::testing {
namespace {

namespace fs = std::filesystem;
using Eigen::Vector3d;

const fs::path kFixtures = fs::path(ARRIS_SOURCE_DIR) / "fixtures";

double distance_to_segment_mm(const Vector3d& p, const Vector3d& a, const Vector3d& b) {
  const Vector3d along = b - a;
  const double square = along.squaredNorm();
  const double t = square > 0.0 ? std::clamp((p - a).dot(along) / square, 0.0, 1.0) : 0.0;
  return (p - a - t * along).norm();
}

}  // namespace

const std::set<std::string> kAcceptedFiles = {"result.json",   "run.json",       "log.jsonl",
                                              "corrected.csv", "report.html",    "program.mod",
                                              "deviation.ply", "program_dry.mod"};
const std::set<std::string> kRefusedFiles = {"result.json", "run.json", "log.jsonl", "report.html",
                                             "deviation.ply"};

Job::Job(const std::string& part) {
  for (const auto& entry : fs::directory_iterator(kFixtures / part)) {
    const std::string extension = entry.path().extension().string();
    if (extension == ".toml" || extension == ".csv" || extension == ".stl")
      fs::copy_file(entry.path(), file(entry.path().filename().string()));
  }
}

void Job::replace(const std::string& name, const std::string& from, const std::string& to) const {
  std::string text = text_of(file(name));
  const std::size_t at = text.find(from);
  ASSERT_NE(at, std::string::npos) << name << " has no " << from;
  put(name, text.replace(at, from.size(), to));
}

void Job::put_scan(const std::string& name, const synthetic::SyntheticScan& scan) const {
  synthetic::write_ply(file(name), scan);
}

Ran Job::run(const std::string& scan, const std::string& out, const std::string& more) const {
  return arris("run recipe.toml --scan " + scan + " --out " + out + " " + more);
}

std::set<std::string> Job::names(const std::string& below) const {
  std::set<std::string> found;
  for (const auto& entry : fs::directory_iterator(file(below)))
    found.insert(entry.path().filename().string());
  return found;
}

synthetic::SyntheticScan fe_scan(const std::string& part, const synthetic::ScanOptions& options,
                                 std::uint64_t seed) {
  return synthetic::sample_scan(synthetic::load_fe_part(kFixtures / "fe" / part), options, seed);
}

synthetic::ScanOptions usual_options(const std::string& part) {
  synthetic::ScanOptions options;
  if (part == "porthole") options.points = 6000;
  return options;
}

Vector3d Table::triple(std::size_t row, std::size_t column) const {
  const std::vector<std::string>& cells = rows.at(row);
  return {std::stod(cells.at(column)), std::stod(cells.at(column + 1)), std::stod(cells.at(column + 2))};
}

Table read_table(const fs::path& file) {
  Table table;
  std::ifstream stream(file);
  for (std::string line; std::getline(stream, line);) {
    if (line.starts_with('#')) {
      table.comment = line;
    } else if (table.header.empty()) {
      table.header = line;
    } else {
      std::vector<std::string> cells;
      std::istringstream row(line);
      for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
      table.rows.push_back(std::move(cells));
    }
  }
  return table;
}

PathError error_to(const Table& path, const std::vector<synthetic::EdgePoint>& truth) {
  PathError error;
  const std::vector<synthetic::EdgeRange> contours = synthetic::contour_ranges(truth);
  for (std::size_t row = 0; row < path.rows.size(); ++row) {
    const Vector3d tip_mm = path.tip_mm(row);
    std::size_t nearest = 0;
    double distance_mm = 1e300;
    for (const synthetic::EdgeRange& contour : contours)
      for (std::size_t k = contour.begin; k < contour.end; ++k) {
        const double d_mm = distance_to_segment_mm(tip_mm, truth[k].true_mm, truth[contour.next(k)].true_mm);
        if (d_mm < distance_mm) nearest = k;
        distance_mm = std::min(distance_mm, d_mm);
      }
    const double cosine = path.axis(row).normalized().dot(truth[nearest].true_normal);
    error.mean_mm += distance_mm;
    error.max_mm = std::max(error.max_mm, distance_mm);
    error.axis_mean_deg += std::acos(std::clamp(cosine, -1.0, 1.0)) * 180.0 / std::numbers::pi;
  }
  const double rows = std::max<double>(1.0, static_cast<double>(path.rows.size()));
  error.mean_mm /= rows;
  error.axis_mean_deg /= rows;
  return error;
}

}  // namespace arris::testing
