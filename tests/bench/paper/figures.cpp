#include "tests/bench/paper/figures.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

#include "tests/bench/paper/figure_lines.hpp"
#include "tests/bench/pictures/bent_part.hpp"
#include "tests/support/released.hpp"

namespace arris::bench {
namespace {

constexpr double kMeshMm = 8.0, kBarrelMeshMm = 25.0, kAxisMm = 45.0;
constexpr int kPaperPieces = 6;
constexpr std::size_t kAxisEvery = 6;
constexpr report::Rgb kSegments[] = {{0, 90, 170}, {214, 98, 28}};
const std::string kArc = "arc length along the nominal contour, mm";

PartPicture blank(const BenchPart& part, const std::string& title, const std::string& subtitle) {
  PartPicture picture;
  picture.title = title;
  picture.subtitle = subtitle;
  picture.normal = mean_edge_normal(part.truth);
  return picture;
}

Figure deformation(const BenchPart& part) {
  return {"figure-02-deformation.png",
          part_png(bent_part_picture(
              part, "Figure 2: the clamped porthole panel and the contour of the drawing", kMeshMm))};
}

/// Heights of the paths over the rigid one along the true normal: what a model of the bending must say.
Figure projection_model(const ScanTrial& trial, const std::vector<NamedPath>& paths) {
  Plot plot{"Figure 3: the bending of the porthole's edge, and what models of it say",
            "height of the edge over the rigidly carried contour, along the normal; usual scan, seed 1",
            kArc,
            "height, mm",
            {},
            {}};
  const Truth& truth = trial.part().truth;
  const PlotLine rigid = error_line(truth, paths.front(), Along::kNormal, true);
  PlotLine edge{"the true edge", {34, 34, 34}, {}, false};
  for (const Eigen::Vector2d& p : rigid.points_mm) edge.points_mm.emplace_back(p.x(), -p.y());
  plot.lines.push_back(edge);
  for (std::size_t i = 1; i < paths.size(); ++i) {
    const std::vector<RowError> own = truth.rows(paths[i].path.tips_mm, true),
                                base = truth.rows(paths.front().path.tips_mm, true);
    PlotLine line{paths[i].name, paths[i].colour, {}, false};
    for (std::size_t r = 0; r < own.size(); ++r)
      line.points_mm.emplace_back(base[r].arc_mm, own[r].normal_mm - base[r].normal_mm);
    std::stable_sort(line.points_mm.begin(), line.points_mm.end(),
                     [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) { return a.x() < b.x(); });
    plot.lines.push_back(std::move(line));
  }
  return {"figure-03-projection.png", plot_png(plot)};
}

Figure segments(const BenchPart& part, const SubdivisionOptions& options, double mesh_mm,
                const std::string& file, const std::string& title) {
  const Curve& contour = part.cad.contours[0];
  const Subdivision subdivision(contour, options);
  PartPicture picture = blank(
      part, title,
      fmt::format("{} segments on {:.0f} mm; each reaches {:.0f} % of the shorter neighbour past its cuts",
                  subdivision.segments().size(), contour.length_mm(), 50.0 * options.overlap_ratio));
  picture.mesh = part.fe.mesh(mesh_mm, false);
  for (std::size_t z = 0; z < subdivision.segments().size(); ++z) {
    const Segment& segment = subdivision.segments()[z];
    PartLine line{{z < 2 ? (z == 0 ? "segment" : "its neighbour") : "",
                   {kSegments[z % 2], 6.0, {}, 1.0},
                   std::nullopt,
                   false},
                  {},
                  false};
    for (double s = segment.begin_mm; s < segment.end_mm + 1.0; s += 1.0)
      line.points_mm.push_back(contour.point_mm(contour.wrap_mm(std::min(s, segment.end_mm))));
    picture.dots_mm.push_back(line.points_mm.front());
    picture.lines.push_back(std::move(line));
  }
  return {file, part_png(picture)};
}

/// Round figures of exaggeration, so that the worst error becomes about a tenth of the part.
double exaggeration(const Truth& truth, const NamedPath& worst, bool deformed) {
  Eigen::AlignedBox3d box;
  for (const synthetic::EdgePoint& e : truth.edge()) box.extend(e.nominal_mm);
  double largest_mm = 1e-6, factor = 1.0;
  for (const RowError& row : truth.rows(worst.path.tips_mm, deformed))
    largest_mm = std::max(largest_mm, row.distance_mm);
  for (const double next : {2.0, 5.0, 10.0, 20.0, 50.0, 100.0})
    if (next * largest_mm < 0.12 * box.diagonal().norm()) factor = next;
  return factor;
}

Figure registered(const BenchPart& part, const std::vector<NamedPath>& paths, double mesh_mm,
                  const std::string& file, const std::string& title) {
  const double factor = exaggeration(part.truth, paths.front(), true);
  PartPicture picture = blank(
      part, title,
      fmt::format("distances from the true edge drawn {:.0f} times as large; usual scan, seed 1", factor));
  picture.mesh = part.fe.mesh(mesh_mm, true);
  add_edge(picture, part.truth, true, "true edge");
  for (const NamedPath& path : paths)
    picture.lines.push_back(exaggerated_line(part.truth, path, factor, true));
  return {file, part_png(picture)};
}

Figure measured(const BenchPart& part, const synthetic::SyntheticScan& scan, const std::string& name) {
  PartPicture picture =
      blank(part, "Figure 7: nose cone, model and measurement",
            fmt::format("{} points, {}; the scan at its true pose", scan.points_mm.size(), name));
  picture.mesh = part.fe.mesh(kBarrelMeshMm, true);
  picture.shows_whole_mesh = true;
  const RigidMotion cad_from_scan = scan.scan_from_cad.inverse();
  for (const Eigen::Vector3d& p : scan.points_mm) picture.points_mm.emplace_back(cad_from_scan * p);
  add_edge(picture, part.truth, false, "contour of the drawing");
  return {"figure-07-scan.png", part_png(picture)};
}

/// Stretches of the contour inside the scan's missing discs.
std::vector<std::pair<double, double>> gaps_of(const synthetic::SyntheticScan& scan) {
  std::vector<std::pair<double, double>> gaps;
  for (const synthetic::EdgePoint& e : scan.edge) {
    const bool is_missing =
        std::any_of(scan.missing.begin(), scan.missing.end(), [&](const synthetic::MissingDisc& disc) {
          return (e.true_mm - disc.centre_mm).norm() < disc.radius_mm;
        });
    if (!is_missing) continue;
    if (gaps.empty() || e.arc_mm - gaps.back().second > 3.0) gaps.emplace_back(e.arc_mm, e.arc_mm);
    gaps.back().second = e.arc_mm;
  }
  return gaps;
}

Figure residual(const ScanTrial& trial, const std::vector<NamedPath>& paths, const std::string& name) {
  Plot plot{"Figure 10: registration error along the nose cone's contour",
            name + ", seed 1; distance from the true edge; grey: nothing was scanned there",
            kArc,
            "distance, mm",
            {},
            gaps_of(trial.scan())};
  for (const NamedPath& path : paths)
    plot.lines.push_back(error_line(trial.part().truth, path, Along::kDistance, true));
  return {"figure-10-residual.png", plot_png(plot)};
}

Figure tool_axes(const BenchPart& part, const NamedPath& ours) {
  PartPicture picture = blank(part, "Figure 11: corrected path and tool axes on the clamped nose cone",
                              "true scale; " + ours.name + "; usual scan, seed 1");
  picture.mesh = part.fe.mesh(kBarrelMeshMm, true);
  picture.lines.push_back(
      {{"corrected path", {ours.colour, 4.0, {}, 1.0}, std::nullopt, false}, ours.path.tips_mm, true});
  for (std::size_t i = 0; i < ours.path.tips_mm.size(); i += kAxisEvery)
    picture.axes_mm.emplace_back(ours.path.tips_mm[i], ours.path.tips_mm[i] + kAxisMm * ours.path.axes[i]);
  return {"figure-11-tool-axes.png", part_png(picture)};
}

const NamedPath& named(const std::vector<NamedPath>& paths, const std::string& name) {
  const auto found =
      std::find_if(paths.begin(), paths.end(), [&](const NamedPath& path) { return path.name == name; });
  if (found == paths.end()) throw Error(Fault::kBug, "the figures lack the method " + name);
  return *found;
}

}  // namespace

std::vector<Figure> porthole_figures(const BenchPart& porthole) {
  const synthetic::SyntheticScan scan = sample_scan(porthole.fe, {}, 1);
  ScanTrial trial(porthole, scan);
  const std::vector<NamedPath> paths = figure_paths(trial);
  return {deformation(porthole), projection_model(trial, paths),
          segments(porthole, equal_pieces(trial, kPaperPieces), kMeshMm, "figure-05-porthole-segments.png",
                   "Figure 5: subdivision of the porthole's contour, six segments as in the paper"),
          registered(porthole, paths, kMeshMm, "figure-06-porthole-registered.png",
                     "Figure 6: the porthole's contour as the methods register it")};
}

std::vector<Figure> nosecone_figures(const BenchPart& nosecone) {
  const NamedScan hard = nosecone_scans().back();
  const synthetic::SyntheticScan usual = sample_scan(nosecone.fe, {}, 1),
                                 gapped = sample_scan(nosecone.fe, hard.options, 1);
  ScanTrial trial(nosecone, usual), hard_trial(nosecone, gapped);
  const std::vector<NamedPath> paths = figure_paths(trial);
  return {measured(nosecone, gapped, hard.name),
          segments(nosecone, trial.options().subdivision.subdivision, kBarrelMeshMm,
                   "figure-08-nosecone-segments.png", "Figure 8: subdivision of the nose cone's contour"),
          registered(nosecone, paths, kBarrelMeshMm, "figure-09-nosecone-registered.png",
                     "Figure 9: the cockpit's contour as the methods register it"),
          residual(hard_trial, figure_paths(hard_trial), hard.name),
          tool_axes(nosecone, named(paths, subdivision().name))};
}

std::vector<Figure> release_figures(const BenchPart& part) {
  const synthetic::SyntheticScan scan = sample_scan(part.fe, {}, 1);
  ScanTrial trial(part, scan);
  const ReleaseMap map(part.fe);
  std::vector<NamedPath> paths = figure_paths(trial);
  paths.insert(paths.begin(), {nominal_path().name, {110, 110, 110}, trial.nominal()});
  for (NamedPath& path : paths) path.path.tips_mm = map.released_mm(path.path.tips_mm);

  const double factor = exaggeration(part.truth, paths[1], false);
  PartPicture picture =
      blank(part, "Figure 13: the contour of the released part, " + part.fe.name(),
            fmt::format("deviations from the drawing drawn {:.0f} times as large; usual scan, "
                        "seed 1",
                        factor));
  picture.mesh = part.fe.mesh(kMeshMm, false);
  picture.is_oblique = false;
  add_edge(picture, part.truth, false, "drawing");
  Plot plot{"Figure 14: error of the released contour, " + part.fe.name(),
            "in the surface, across the contour, positive towards the void; usual scan, seed 1",
            kArc,
            "across, mm",
            {},
            {}};
  for (const NamedPath& path : paths) {
    picture.lines.push_back(exaggerated_line(part.truth, path, factor, false));
    plot.lines.push_back(error_line(part.truth, path, Along::kAcross, false));
  }
  return {{"figure-13-" + part.fe.name() + "-released.png", part_png(picture)},
          {"figure-14-" + part.fe.name() + "-error.png", plot_png(plot)}};
}

}  // namespace arris::bench
