#include "registration/strain.hpp"

#include <numbers>

#include "registration/found_edge.hpp"

namespace arris {
namespace {

/// Lengthening of the contours at a depth below the face, by a field that does not follow the edge's own
/// error: a fibre of that depth is carried rigidly, so the face's strain less depth times change of
/// curvature.
double stretch(const CadModel& cad, const DeformationField& field, double depth_mm) {
  double carried_mm = 0.0, nominal_mm = 0.0;
  for (const Curve& curve : cad.contours) {
    Contour nominal, image;
    nominal.closed = image.closed = curve.closed();
    along(curve, [&](double s_mm) {
      const Eigen::Vector3d fibre_mm = -depth_mm * curve.normal(s_mm);
      const MappedPoint place = field.map(curve.point_mm(s_mm));
      nominal.points_mm.push_back(curve.point_mm(s_mm) + fibre_mm);
      image.points_mm.push_back(place.p_scan_mm + place.rotation_scan_from_cad * fibre_mm);
    });
    carried_mm += length_mm(image);
    nominal_mm += length_mm(nominal);
  }
  return nominal_mm > 0.0 ? carried_mm / nominal_mm - 1.0 : 0.0;
}

}  // namespace

void measure_strain(const CadModel& cad, const RegistrationOptions& options, Registration& result) {
  if (options.method == RegistrationMethod::kRigid) return;  // it does not look for any
  // The surface field hardly stretches by its prior: a rim that is longer shows in the edge it follows.
  const std::shared_ptr<const DeformationField> shape =
      options.method == RegistrationMethod::kSurface
          ? result.field
          : std::make_shared<SubdivisionField>(cad, result.contours, options.band_mm, false);
  result.face_strain_ratio = stretch(cad, *shape, 0.0);
  result.mean_strain_ratio =
      options.mid_depth_mm > 0.0 ? stretch(cad, *shape, options.mid_depth_mm) : result.face_strain_ratio;
  if (options.role == ContourRole::kCut) return;  // no rim that could be longer than drawn
  double length = 0.0, limit_mm = 0.0;
  for (const ContourResult& contour : result.contours) {
    length += contour.motion.nominal().length_mm();
    limit_mm +=
        2.0 * std::numbers::pi * contour.edge.edge_limit_mm();  // a rim that wide all round is so much longer
  }
  result.strain_limit_ratio = length > 0.0 ? limit_mm / length : 0.0;
}

}  // namespace arris
