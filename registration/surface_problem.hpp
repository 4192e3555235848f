#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "registration/common_bend.hpp"
#include "registration/common_height.hpp"
#include "registration/edge_strips.hpp"
#include "registration/surface_ground.hpp"
#include "registration/surface_pairs.hpp"
#include "registration/surface_refine.hpp"

namespace arris {

/// A surface field in the making: what the scan shows of it as it stands, the normal equations of that and of
/// the priors, and the rounds that solve them. Which points take part, how stiff the sheet is and where nodes
/// stand is chosen by refine_surface().
class SurfaceProblem {
 public:
  static constexpr double kUnfollowedMm = 0.008;  ///< of a bent surface, by nodes 30 mm apart: height
  static constexpr std::size_t kFewestPointsANode = 8;
  static constexpr double kScaleSigmas = 4.0;

  /// All must outlive this.
  SurfaceProblem(const CadModel& cad, const ScanModel& scan, const RigidMotion& rigid_scan_from_cad,
                 const SurfaceOptions& options);

  /// Of the CAD about the contours that carries the field; -1: all of it.
  [[nodiscard]] double band_mm() const;
  /// No deformation, and everything looked at coarsely.
  void start_over();
  /// The field stays, partners and edges may be far off.
  void look_coarsely();
  /// A dense scan is fitted by few of its points first: one of 16, of 4, of 1, as long as the nodes see
  /// enough.
  [[nodiscard]] std::vector<std::size_t> levels() const;
  /// From now on one of so many points takes part.
  void take_points(std::size_t one_of);
  /// Rounds until the field stands still at the finest scales. The edge sharpens only as the field follows:
  /// else it is held where the first rounds found it.
  void settle();
  /// Looks for burrs from the field as it stands; true: other places than before.
  bool call_burrs();
  /// The same field on other nodes; all points take part already.
  void stand_on(SurfaceGround other);
  /// What the scan does not show may bend by as much as was expected: nothing says that it bends alike too.
  void mark_seen();
  /// How far the fit's bends scatter about their common one, over what the options expect.
  [[nodiscard]] double scatter_ratio() const;
  /// What points within half a node spacing share.
  [[nodiscard]] CommonHeight common_height() const {
    return CommonHeight(pairs, 0.5 * fit.basis->spacing_mm(), gate_mm());
  }
  /// What neighbouring points share of height beyond the field; not less than such nodes cannot follow.
  [[nodiscard]] double shared_height_mm(const CommonHeight& common) const;
  /// Partners, residuals, strips and the bend that all share, under the field as it is.
  void look();
  /// The strips beside the edges under another field; fit.shift_mm stays.
  void lay_strips(const std::vector<Eigen::Vector3d>& shift_mm, bool walls_count = true);
  /// Normal equations of the field as it was last looked at.
  [[nodiscard]] SurfaceSystem assemble() const;
  /// One Gauss-Newton step; returns the rms move of the followed contours across and normal to them.
  double step();
  /// Points farther from the surface tell nothing of edges and shapes.
  [[nodiscard]] double gate_mm() const { return EdgeStrips::kGateSigmas * fit.sigma_mm; }
  /// A round's move that no longer matters.
  [[nodiscard]] double settled_mm() const;

  SheetPrior prior;
  SurfaceFit fit;
  SurfaceGround ground;
  std::optional<EdgeStrips> strips;
  std::vector<SurfacePair> pairs;
  bool bends_alike = false;  ///< about a common bend, which is taken out of the equations
  double unfollowed_mm = kUnfollowedMm;
  double scale_mm = 0.0, tau_mm = 0.0;  ///< of the points' weights; of the edges' support

 private:
  void lay_out_strips(std::size_t one_of);
  [[nodiscard]] CommonBend common_bend(const SheetPrior& of) const;
  /// What a point is worth: its noise, and what nodes so far apart cannot follow of a bent surface. That is
  /// alike for all points between the same nodes, so more of them do not average it away; trusted by their
  /// noise alone, many points trade it for a slide in the surface, where only the edge holds the field.
  [[nodiscard]] double point_sigma_mm() const;
  /// What the scan shows of the surface and the edges.
  [[nodiscard]] SurfaceSystem seen() const;
  [[nodiscard]] SurfaceSystem sheet_priors(const SheetPrior& of) const;
  void add_weak_priors(SurfaceSystem& system) const;
  /// Share of a step that carries no edge out of its points' sight. Burrs that some of the points show and
  /// all of them unmask leave an edge so far out that nothing there holds it: its step inward, by the strip's
  /// density alone, once was 7 mm.
  [[nodiscard]] double within_sight(const Eigen::VectorXd& offset_move_mm) const;
  [[nodiscard]] double moved_mm(const std::vector<Eigen::Vector3d>& moved) const;
  /// Sums add(begin, end, system) over fixed chunks, in their order.
  template <class Add>
  [[nodiscard]] SurfaceSystem summed(std::size_t count, const Add& add) const;

  const CadModel& cad_;
  const ScanModel& scan_;
  const SurfaceOptions& options_;
  std::vector<const Curve*> edges_;
  std::vector<std::size_t> near_, points_;  // scan points near the contours, and those that take part
  double strip_reach_mm_ = 20.0;
};

}  // namespace arris
