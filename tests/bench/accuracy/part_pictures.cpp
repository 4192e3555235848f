#include "tests/bench/accuracy/part_pictures.hpp"

#include <fmt/format.h>

#include <algorithm>

#include "tests/bench/pictures/bent_part.hpp"
#include "tests/bench/pictures/plot.hpp"
#include "tests/support/coverage.hpp"
#include "tests/support/one_run.hpp"

namespace arris::bench {
namespace {

constexpr double kMeshBands = 0.1;  // of the coloured triangles, in widths of the scan's band
constexpr double kBoundSigmas = 1.96;
constexpr report::Rgb kNormal{0, 90, 170}, kAcross{214, 98, 28};

/// One direction's errors, and above and below zero what was stated of them; a line a contour.
void add_lines(Plot& plot, const ToolPath& path, const std::vector<StatedError>& stated,
               StatedError::Direction direction, const std::string& name, report::Rgb colour) {
  const std::vector<double> arc_mm = arc_along_mm(path);
  double begin_mm = 0.0;
  bool is_first = true;
  for (const PathRange& range : polylines(path)) {
    PlotLine error{is_first ? name : "", colour, {}, false};
    PlotLine above{is_first ? "its 95 % bound" : "", colour, {}, true}, below{"", colour, {}, true};
    for (std::size_t i = range.begin; i < range.end; ++i) {
      const double s_mm = begin_mm + arc_mm[i], bound_mm = kBoundSigmas * stated[i].sd[direction];
      error.points_mm.emplace_back(s_mm, stated[i].error[direction]);
      above.points_mm.emplace_back(s_mm, bound_mm);
      below.points_mm.emplace_back(s_mm, -bound_mm);
    }
    begin_mm += arc_mm[range.end - 1];
    is_first = false;
    plot.lines.insert(plot.lines.end(), {std::move(error), std::move(above), std::move(below)});
  }
}

Figure error_figure(const BenchPart& part, const std::vector<StatedError>& stated) {
  Plot plot;
  plot.title = part.fe.name() + ": error of the corrected path along its contours";
  plot.subtitle =
      "from the true edge, signed: normal to the surface, in it across the contour; noise 0.05 mm, seed 1";
  plot.x_label = "arc length along the path, contour after contour, mm";
  plot.y_label = "error, mm";
  add_lines(plot, part.drawing.path, stated, StatedError::kNormal, "normal", kNormal);
  add_lines(plot, part.drawing.path, stated, StatedError::kAcross, "across", kAcross);
  return {part.fe.name() + "-error.png", shrunk(plot_png(plot))};
}

std::vector<Eigen::Vector3d> axes_of(const ToolPath& path) {
  std::vector<Eigen::Vector3d> axes;
  for (const PathPoint& row : path.points) axes.push_back(row.axis);
  return axes;
}

}  // namespace

std::vector<Figure> part_pictures(const BenchPart& part) {
  std::vector<Figure> figures;
  const PartPicture bent =
      bent_part_picture(part, part.fe.name() + ": how it is bent", part.fe.band_mm() * kMeshBands);
  figures.push_back({part.fe.name() + "-bent.png", shrunk(part_png(bent))});
  const synthetic::SyntheticScan scan = sample_scan(part.fe, {}, 1);
  const PointCloud cloud = scan.cloud();
  const RigidMotion cad_from_local = scan.scan_from_cad.inverse() * Eigen::Translation3d(cloud.offset_mm);
  const OneRun run = run_one({part.recipe, part.cad, part.drawing.path, part.threads}, cloud,
                             calibrated_options(part.recipe, part.threads));
  if (!run.accepted()) return figures;
  figures.push_back(error_figure(part, stated_errors(part.truth, *run.found.field, scan, cad_from_local,
                                                     {part.path_mm, axes_of(part.drawing.path)})));
  return figures;
}

std::string pictures_text(const std::vector<Figure>& figures, const std::string& folder) {
  std::string text;
  for (const Figure& figure : figures)
    text += fmt::format("![{}]({}/{})\n", figure.file.substr(0, figure.file.find('.')), folder, figure.file);
  return text;
}

}  // namespace arris::bench
