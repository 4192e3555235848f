#include "report/definitions.hpp"

namespace arris::report {

const std::vector<Definition>& definitions() {
  static const std::vector<Definition> kDefinitions = {
      {"unit", "All lengths are millimetres; angles are degrees where the name says so, else radians."},
      {"deviation",
       "Shortest distance from a scan point to the CAD surface after the rigid alignment. Positive: the "
       "point lies "
       "outside the material, on the side to which the CAD normal points. Points beyond reach of the CAD "
       "have no data "
       "and count nowhere."},
      {"rms and sigma",
       "RMS is about zero, sigma about the mean (population form): RMS^2 = mean^2 + sigma^2. Percentiles are "
       "linear "
       "between the ordered values."},
      {"in tolerance", "|deviation| is at most half the full width of the zone, limits included."},
      {"profile value",
       "2 max|d|: the width of the smallest zone, centred on the nominal, that holds every point."},
      {"verdict",
       "PASS: value + U is within the tolerance. FAIL: value - U is over it. Else INDETERMINATE. U is the "
       "expanded "
       "uncertainty (k = 2) of the value. Where U is not stated the rule is simple acceptance."},
      {"alignment rms",
       "Root mean square of the point-to-plane distances of the pairs that were kept after trimming, in the "
       "band "
       "around the contours, at the end of the rigid alignment. It is no deviation of the part."},
      {"overlap", "Share of the CAD points in the band that have a scan partner."},
      {"stage residual",
       "Root mean square of the distances of the edge pairs after that stage; a fit's residual."},
      {"segment rms", "The same for the pairs of one segment, at its last iteration."},
      {"error before",
       "Distance from the edge found in the scan to the nominal contour carried by the rigid alignment "
       "alone."},
      {"error after",
       "Distance from the same edge to the contour carried by the chosen method: across (in the surface, "
       "signed) and "
       "normal (along the surface normal, signed) taken together. Where no edge was seen there is no value. "
       "Both "
       "contain the noise of the scan; neither is an error against a known truth."},
      {"shift", "How far a path point moves beyond the rigid alignment."},
      {"data, prior",
       "Data: scan points near the row decided its place. Prior: none were near, and the neighbours or the "
       "rigid "
       "motion decided."},
      {"edge limit E",
       "1 / (point density x 50 mm): about the best that an edge can be placed across itself."},
      {"edge offset",
       "How far out, in the void, the scanner shows an edge (negative: inside the material), and its "
       "standard deviation; a property of the scanner, taken off. Not calibrated: zero is taken, and no edge "
       "is stated better across than that standard deviation."},
      {"surface limit",
       "sigma / sqrt(n), noise over the root of the points within 10 mm: the same along the normal."},
  };
  return kDefinitions;
}

}  // namespace arris::report
