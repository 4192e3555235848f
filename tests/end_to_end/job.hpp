#pragma once

#include <Eigen/Core>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "fixtures/synthetic/scan.hpp"
#include "tests/cli/run_arris.hpp"

namespace arris::testing {

/// A part folder of its own for one test: recipe.toml with all that it names, scans beside it, results in it.
class Job {
 public:
  /// part: folder under fixtures/, as "fe/sheet" or "example".
  explicit Job(const std::string& part);

  [[nodiscard]] const std::filesystem::path& folder() const { return folder_.path(); }
  [[nodiscard]] std::filesystem::path file(const std::string& name) const { return folder() / name; }
  /// Replaces the first `from` in a file by `to`; a test failure when it is not there.
  void replace(const std::string& name, const std::string& from, const std::string& to) const;
  /// Writes a scan as PLY in float, with normals when the scan writes them.
  void put_scan(const std::string& name, const synthetic::SyntheticScan& scan) const;
  void put(const std::string& name, const std::string& bytes) const { folder_.write(name, bytes); }
  /// `arris ARGUMENTS` in the folder.
  [[nodiscard]] Ran arris(const std::string& arguments) const { return run_arris(arguments, folder()); }
  /// `arris run recipe.toml --scan SCAN --out OUT MORE`.
  [[nodiscard]] Ran run(const std::string& scan, const std::string& out, const std::string& more = "") const;
  /// Everything in the folder, hidden names as well, not what lies deeper.
  [[nodiscard]] std::set<std::string> names(const std::string& below = "") const;

 private:
  TestFolder folder_;
};

/// A scan of a part under fixtures/fe with its truth; a random pose unless options say otherwise.
[[nodiscard]] synthetic::SyntheticScan fe_scan(const std::string& part, const synthetic::ScanOptions& options,
                                               std::uint64_t seed);

/// As a finite-element part is usually scanned; the porthole with more points than the paper's 1,500.
[[nodiscard]] synthetic::ScanOptions usual_options(const std::string& part);

/// A CSV as a stranger would read it: one comment line at most, header, numbers and words split at commas.
struct Table {
  std::string comment, header;
  std::vector<std::vector<std::string>> rows;
  [[nodiscard]] Eigen::Vector3d tip_mm(std::size_t row) const { return triple(row, 0); }
  [[nodiscard]] Eigen::Vector3d axis(std::size_t row) const { return triple(row, 3); }
  [[nodiscard]] Eigen::Vector3d triple(std::size_t row, std::size_t column) const;
};
[[nodiscard]] Table read_table(const std::filesystem::path& file);

/// How far a path is from closed curves with normals.
struct PathError {
  double mean_mm = 0.0, max_mm = 0.0;
  double axis_mean_deg = 0.0;
};
[[nodiscard]] PathError error_to(const Table& path, const std::vector<synthetic::EdgePoint>& truth);

/// Names of what a finished run leaves; an accepted one with a program, or a refused one.
extern const std::set<std::string> kAcceptedFiles;
extern const std::set<std::string> kRefusedFiles;

}  // namespace arris::testing
