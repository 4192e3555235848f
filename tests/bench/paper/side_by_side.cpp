#include <fmt/format.h>

#include "tests/bench/paper/experiments.hpp"

namespace arris::bench {
namespace {

constexpr int kPaperPieces = 6;

std::string scan_line(const BenchPart& part, const synthetic::ScanOptions& options, int seeds) {
  return fmt::format(
      "Scan: {} points, noise {:.2f} mm, {:.0f} % of the contour missing; seeds 1 to {}, any pose.\n\n",
      options.points < 0 ? static_cast<std::int64_t>(part.fe.scan_points()) : options.points,
      options.noise_sigma_mm, 100.0 * options.missing_ratio, seeds);
}

}  // namespace

std::vector<NamedScan> nosecone_scans() {
  std::vector<NamedScan> scans(4);
  scans[0].name = "no noise, nothing missing";
  scans[0].options.noise_sigma_mm = 0.0;
  scans[1].name = "noise 0.1 mm, nothing missing";
  scans[1].options.noise_sigma_mm = 0.1;
  scans[2].name = "no noise, 10 % missing";
  scans[2].options.noise_sigma_mm = 0.0;
  scans[2].options.missing_ratio = 0.1;
  scans[3].name = "noise 0.1 mm, 10 % missing";
  scans[3].options.noise_sigma_mm = 0.1;
  scans[3].options.missing_ratio = 0.1;
  return scans;
}

std::string porthole_section(const BenchPart& porthole, int seeds) {
  std::vector<Method> methods = {nominal_path(), best_rigid_motion(), paper_rigid_icp(), rigid_icp()};
  for (Method& method : projections()) methods.push_back(std::move(method));
  for (Method& method :
       std::vector<Method>{paper_pieces(kPaperPieces), subdivision_pieces(kPaperPieces), subdivision()})
    methods.push_back(std::move(method));
  const synthetic::ScanOptions scan;
  return scan_line(porthole, scan, seeds) +
         error_table(compare(porthole, scan, methods, seeds), rigid_icp().name);
}

std::string nosecone_section(const BenchPart& nosecone, int seeds) {
  std::string text;
  for (const NamedScan& scan : nosecone_scans())
    text += "#### Nose cone, " + scan.name + "\n\n" + scan_line(nosecone, scan.options, seeds) +
            error_table(compare(nosecone, scan.options, all_methods(), seeds), rigid_icp().name) + "\n";
  return text;
}

}  // namespace arris::bench
