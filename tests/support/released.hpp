#pragma once

#include <Eigen/Core>
#include <vector>

#include "fixtures/synthetic/fe_part.hpp"

namespace arris::bench {

/// The finite element map of one part, carried on beyond its face, and its inverse: what is cut in the
/// clamped part goes back to the place in the drawing that it springs to when the clamps let go. CAD frame,
/// mm.
///
/// A point X of the drawing that is off the face or beyond its edge moves as if the material there went on:
/// with the foot X0 of X on the nominal face, x = x0 + F (X - X0), where F stretches and turns the face's two
/// tangents as the element does at X0 and carries its unit normal to the deformed one. On the face it is the
/// elements' own map. Neighbouring elements' normals differ a little at their border, so 5 mm off the face
/// the way there and back is exact to 0.001 mm.
class ReleaseMap {
 public:
  /// Keeps a reference.
  explicit ReleaseMap(const synthetic::FePart& part) : part_(part) {}
  /// Drawing -> clamped.
  [[nodiscard]] Eigen::Vector3d clamped_mm(const Eigen::Vector3d& nominal_mm) const;
  /// Clamped -> drawing, by Newton's method on the map above. Throws Error(kBug) where it does not converge:
  /// farther from the face than the part's radius of bending.
  [[nodiscard]] Eigen::Vector3d released_mm(const Eigen::Vector3d& clamped_mm) const;
  [[nodiscard]] std::vector<Eigen::Vector3d> released_mm(
      const std::vector<Eigen::Vector3d>& clamped_mm) const;

 private:
  struct Local {
    Eigen::Vector3d place_mm;
    Eigen::Matrix3d gradient;  ///< F
  };
  [[nodiscard]] Local at(const Eigen::Vector3d& nominal_mm) const;
  const synthetic::FePart& part_;
};

}  // namespace arris::bench
