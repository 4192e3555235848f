#include "registration/edge_calibration.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace arris {
namespace {

constexpr double kStretchMm = 50.0;  // an edge is known up to a smooth shift over about this length
constexpr double kSampleMm = 2.0;
constexpr double kSeenRatio = 0.9;     // of a contour's length: with less a shift does not average out
constexpr double kMostHeightMm = 0.1;  // rms along a contour: what a rigid fit may leave of a flat reference
constexpr double kMostWanderMm = 0.1;  // scatter of the stretches, where the scan could show less
constexpr double kWanderEdgeLimits = 3.0;  // and where it could not
constexpr double kAgreeSigmas = 4.0;
// The fit by support shows a sharp edge 0.2 to 0.5 edge limits inside the material (uniform scans, 0.2 to 1.4
// points/mm^2). It does so on parts as well, but not to the same amount by every method and spacing.
constexpr double kFitEdgeLimits = 0.4;
constexpr double kLeastSdMm = 1e-3;      // a good reference is not known better
constexpr double kSharedErrorMm = 0.02;  // that two contours of a good reference may differ by

double mean(const std::vector<double>& values) {
  double sum = 0.0;
  for (const double value : values) sum += value;
  return values.empty() ? 0.0 : sum / static_cast<double>(values.size());
}

double sum_of_squares_about(const std::vector<double>& values, double centre) {
  double sum = 0.0;
  for (const double value : values) sum += (value - centre) * (value - centre);
  return sum;
}

/// How far out the stretches of a contour are shown, and how high they lie; mm.
struct Stretches {
  std::vector<double> out_mm, height_mm;
};
Stretches stretches_of(const Curve& curve, const EdgeFit& edge) {
  const int count = std::max(1, static_cast<int>(std::lround(curve.length_mm() / kStretchMm)));
  const double length_mm = curve.length_mm() / count;
  Stretches stretches;
  for (int k = 0; k < count; ++k) {
    std::vector<double> out_mm, height_mm;
    for (double s_mm = k * length_mm; s_mm < (k + 1) * length_mm; s_mm += kSampleMm) {
      if (!edge.seen_at(s_mm)) continue;
      const SplineRow row = edge.spline.at(s_mm);
      out_mm.push_back(-row.dot(edge.across));
      height_mm.push_back(row.dot(edge.height));
    }
    if (out_mm.empty()) continue;
    stretches.out_mm.push_back(mean(out_mm));
    stretches.height_mm.push_back(mean(height_mm));
  }
  return stretches;
}

/// One after the other; the first that says no ends it.
class Calibrator {
 public:
  Calibrator(const CadModel& cad, const EdgeCalibrationOptions& options) : cad_(cad), options_(options) {}

  EdgeCalibration run(std::span<const Registration> scans) {
    for (std::size_t i = 0; i < scans.size() && found_.usable(); ++i) add_scan(i, scans[i]);
    if (found_.usable()) conclude();
    return std::move(found_);
  }

 private:
  void add_scan(std::size_t scan, const Registration& registration) {
    for (std::size_t c = 0; c < registration.contours.size() && found_.usable(); ++c)
      found_.contours.push_back(add_contour(scan, cad_.contours[c], registration.contours[c].edge));
  }

  CalibratedContour add_contour(std::size_t scan, const Curve& curve, const EdgeFit& edge) {
    const Stretches stretches = stretches_of(curve, edge);
    CalibratedContour told;
    told.scan = scan;
    told.id = curve.contour().id;
    told.seen_ratio = edge.seen_ratio();
    told.stretches = stretches.out_mm.size();
    told.used = curve.closed() && told.seen_ratio >= kSeenRatio && told.stretches > 0;
    if (!told.used) return told;
    const double count = static_cast<double>(told.stretches);
    told.out_mm = mean(stretches.out_mm);
    const double squares = sum_of_squares_about(stretches.out_mm, told.out_mm);
    told.scatter_mm = count > 1.0 ? std::sqrt(squares / (count - 1.0)) : 0.0;
    doubt_reference(told, std::sqrt(sum_of_squares_about(stretches.height_mm, 0.0) / count),
                    edge.edge_limit_mm());
    squares_ += squares;
    freedom_ += count - 1.0;
    limits_mm_.push_back(edge.edge_limit_mm());
    sum_out_mm_ += count * told.out_mm;
    found_.stretches += told.stretches;
    return told;
  }

  void doubt_reference(const CalibratedContour& told, double height_rms_mm, double edge_limit_mm) {
    const double most_mm = std::max(kMostWanderMm, kWanderEdgeLimits * edge_limit_mm);
    if (height_rms_mm > kMostHeightMm)
      found_.reason = fmt::format(
          "contour {}: the reference is bent: a rigid fit leaves {:.2f} mm rms of height along it, at most "
          "{:.2f}; take a stiff one and lay it down free",
          told.id, height_rms_mm, kMostHeightMm);
    else if (told.scatter_mm > most_mm)
      found_.reason = fmt::format(
          "contour {}: its edge wanders by {:.2f} mm along it, at most {:.2f}: the reference is not "
          "as drawn, has a burr, or the scan is too coarse",
          told.id, told.scatter_mm, most_mm);
  }

  void conclude() {
    if (found_.stretches == 0) {
      found_.reason =
          fmt::format("no closed contour was seen on {:.0f} % of its length: scan the reference all round",
                      100.0 * kSeenRatio);
      return;
    }
    const double count = static_cast<double>(found_.stretches);
    // A few stretches of one circle scatter less than the edge limit by chance alone.
    const double limit_mm = mean(limits_mm_);
    found_.scatter_mm = std::max(freedom_ > 0.0 ? std::sqrt(squares_ / freedom_) : 0.0, limit_mm);
    found_.edge.out_mm = sum_out_mm_ / count;
    const double chance_mm = found_.scatter_mm / std::sqrt(count), fit_mm = kFitEdgeLimits * limit_mm;
    found_.edge.sd_mm = std::max(kLeastSdMm, std::sqrt(chance_mm * chance_mm + fit_mm * fit_mm +
                                                       options_.size_sd_mm * options_.size_sd_mm));
    for (const CalibratedContour& told : found_.contours)
      if (told.used && found_.usable()) doubt_size(told);
    if (found_.usable() && std::abs(found_.edge.out_mm) > ScannerEdge::kMostOutMm)
      found_.reason = fmt::format(
          "the edges are {:+.2f} mm out, at most {:.2f}: is the reference of the size that the drawing says?",
          found_.edge.out_mm, ScannerEdge::kMostOutMm);
    if (found_.usable() && found_.edge.sd_mm >= ScannerEdge::kUncalibratedSdMm)
      found_.reason = fmt::format(
          "the edge is known to {:.3f} mm, no better than without a calibration ({:.3f}): scan more densely, "
          "more often, or a longer edge",
          found_.edge.sd_mm, ScannerEdge::kUncalibratedSdMm);
  }

  void doubt_size(const CalibratedContour& told) {
    const double sd_mm = std::hypot(found_.scatter_mm / std::sqrt(static_cast<double>(told.stretches)),
                                    options_.size_sd_mm + kSharedErrorMm);
    const double apart_mm = std::abs(told.out_mm - found_.edge.out_mm);
    if (apart_mm > kAgreeSigmas * sd_mm)
      found_.reason = fmt::format(
          "contour {} is shown {:+.3f} mm out, all together {:+.3f}: {:.3f} mm apart, at most {:.3f}: is the "
          "reference of the size that the drawing says?",
          told.id, told.out_mm, found_.edge.out_mm, apart_mm, kAgreeSigmas * sd_mm);
  }

  const CadModel& cad_;
  const EdgeCalibrationOptions& options_;
  EdgeCalibration found_;
  double squares_ = 0.0, freedom_ = 0.0, sum_out_mm_ = 0.0;
  std::vector<double> limits_mm_;  // edge limit of each contour used
};

}  // namespace

EdgeCalibration calibrate_edge(const CadModel& cad, std::span<const Registration> scans,
                               const EdgeCalibrationOptions& options) {
  return Calibrator(cad, options).run(scans);
}

}  // namespace arris
