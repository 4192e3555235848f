#pragma once

#include <vector>

#include "registration/pose_search.hpp"
#include "registration/scene.hpp"

namespace arris {

/// Which of the poses found count as fits: limits on their misfits, as shares of the largest distance that
/// scores count.
class PoseFitness {
 public:
  /// edges_needed: the followed contours must be in the scan (role edge).
  PoseFitness(double spacing_mm, double cap_mm, bool edges_needed)
      : spacing_mm_(spacing_mm), cap_mm_(cap_mm), edges_needed_(edges_needed) {}

  /// What a misfit holds beyond the offset of angle-gap edge points, about a spacing.
  [[nodiscard]] double beyond_spacing_mm(double misfit_mm) const;
  /// Enough of its edges are in the scan, and the face ends there.
  [[nodiscard]] bool not_contradicted(const PoseCandidate& pose) const;
  /// So little of its edges is in the scan that it is never taken: it hangs where nothing was scanned.
  [[nodiscard]] bool is_hidden(const PoseCandidate& pose) const;
  /// Leaves no more than a fit does.
  [[nodiscard]] bool fits(const PoseCandidate& pose) const;
  /// So well that nothing else need be tried: what the scan does not show may be beyond its border.
  [[nodiscard]] bool fits_whole(const PoseCandidate& pose) const;
  /// A pose well seen that leaves much only where the scan tells nothing.
  [[nodiscard]] bool fits_where_seen(const PoseCandidate& pose) const;
  /// A pose that leaves much on the contours that it was fitted to, no more than where nothing can be told,
  /// and that others of the drawing confirm, which took no part in the fit.
  [[nodiscard]] bool confirmed_by_others(const PoseCandidate& pose) const;
  /// Whether this one leaves no more than a fit, or than the best pose does by about half.
  [[nodiscard]] bool fits_too(const PoseCandidate& pose, const PoseCandidate& best) const;
  /// How much worse the other pose fits: by what tells the two apart best of the misfit that leaves out no
  /// less than the best pose's contours lack, and of the places where the scan's face goes on, which no clamp
  /// hides; unless one of these speaks for the other.
  [[nodiscard]] double times_worse(const PoseCandidate& other, const PoseCandidate& best) const;
  /// What a fit may leave beyond the spacing.
  [[nodiscard]] double fits_mm() const;
  /// Best first, those that are never taken last.
  void sort(std::vector<PoseCandidate>& found) const;

 private:
  [[nodiscard]] double contradicted_mm(const PoseMisfit& misfit) const;

  double spacing_mm_, cap_mm_;
  bool edges_needed_;
};

}  // namespace arris
