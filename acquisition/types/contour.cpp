#include "acquisition/types/contour.hpp"

namespace arris {

double length_mm(const Contour& contour) {
  double length = 0.0;
  for (std::size_t i = 1; i < contour.points_mm.size(); ++i)
    length += (contour.points_mm[i] - contour.points_mm[i - 1]).norm();
  if (contour.closed && contour.points_mm.size() > 2)
    length += (contour.points_mm.front() - contour.points_mm.back()).norm();
  return length;
}

}  // namespace arris
