#pragma once

#include <Eigen/Core>
#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "acquisition/types/contour.hpp"
#include "acquisition/types/frames.hpp"
#include "acquisition/types/point_cloud.hpp"
#include "acquisition/types/triangle_mesh.hpp"
#include "registration/fixture_targets.hpp"
#include "report/edge_offset.hpp"
#include "report/refinement_summary.hpp"
#include "toolpath/correct.hpp"
#include "toolpath/robot/row_uncertainty.hpp"
#include "toolpath/toolpath.hpp"

namespace arris {

/// A file that took part in the run. Its name is printed, its hash decides.
struct InputFile {
  std::string role;    ///< "scan", "cad", "path", "recipe", "edge_calibration", "cell", "contours"
  std::string name;    ///< file name without folder
  std::string sha256;  ///< lower-case hex
};

/// One number along a contour, by arc length: the paper's figure 10, before (rigid) and after (chosen
/// method).
struct ContourError {
  std::string contour;  ///< "contour 1"
  std::vector<double> arc_mm;
  std::vector<double>
      rigid_mm;  ///< distance found edge - nominal contour carried rigidly; NaN where no edge was seen
  /// From the corrected contour to the found edge, signed, in the surface and across the contour: positive
  /// towards the void (the part has more material than nominal there); NaN: not seen.
  std::vector<double> across_mm;
  /// From the corrected contour to the scan, signed, along the surface normal: positive outside the material;
  /// NaN: not seen.
  std::vector<double> normal_mm;
};

/// Statistics of one set of signed deviations, mm (inspection: RMS about zero, sigma about the mean,
/// population form).
struct DeviationStatistics {
  std::size_t count = 0;
  double min_mm = 0, max_mm = 0, mean_mm = 0, rms_mm = 0, sigma_mm = 0, median_mm = 0, p05_mm = 0, p95_mm = 0;
  double in_tolerance_ratio = 0, over_ratio = 0, under_ratio = 0;
};

enum class Verdict { kPass, kFail, kIndeterminate, kNotJudged };

/// How the part lies: `scan_from_cad` with what is known of its quality.
struct AlignmentSummary {
  RigidMotion scan_from_cad =
      RigidMotion::Identity();  ///< file coordinates of the scan (offset included), mm
  double rms_mm = 0.0;          ///< point to plane, band points, after trimming
  double overlap_ratio = 0.0;   ///< CAD band points that have a scan partner
  std::size_t pairs = 0;
  double runner_up_ratio = 0.0;  ///< score of the second best pose over the best: near 1 is ambiguous
  int equal_poses = 1;           ///< that fit alike and lay the whole tool path on itself
  std::string side_decided_by;   ///< "normals in the file", "seen_from", "initial pose", "nothing"
  std::string start;  ///< "matching loops", "matching pieces of contours", "matching surfaces", "matching the
                      ///< edges of faces", "initial pose"
  std::vector<std::string> free_directions;  ///< motions the data leave undetermined, in words
  std::vector<double>
      covariance_6x6;  ///< row-major, of a small motion of the part about covariance_about_mm, CAD
                       ///< axes: turn (rad), then shift (mm); empty: unknown
  Eigen::Vector3d covariance_about_mm = Eigen::Vector3d::Zero();  ///< CAD frame
};

/// One judged result: the number, its limit, and the words.
struct Judged {
  Verdict verdict = Verdict::kNotJudged;
  double value_mm = 0.0;        ///< 2 max|d| (profile, full zone width)
  double tolerance_mm = 0.0;    ///< full zone width
  double uncertainty_mm = 0.0;  ///< expanded (k = 2); 0 with uncertainty_stated = false: not stated
  bool uncertainty_stated = false;
  std::string text;  ///< "as clamped, not judged", "found edge against nominal", ...
};

/// Everything a run found; the writers read it and compute nothing that is not a summary of it.
struct RunRecord {
  std::string part_number;
  std::string version;  ///< "arris 0.1.0"
  std::vector<InputFile> inputs;
  std::string result_hash;    ///< of the run: report/result_hash
  std::string report_time;    ///< from SOURCE_DATE_EPOCH or the scan file's time; ISO 8601, UTC
  std::string state;          ///< "clamped" | "free"
  std::string role;           ///< "edge" | "cut"
  std::string method;         ///< "rigid" | "subdivision" | ...
  bool has_toolpath = false;  ///< false for `inspect`

  // Acquisition
  std::size_t points_read = 0, points_nonfinite = 0, points_outlier = 0, points_used = 0;
  double spacing_mm = 0.0, noise_sigma_mm = 0.0;
  EdgeOffset edge_offset;
  std::vector<std::string>
      notes;  ///< acquisition and contour notes in plain words (filled holes, dropped loops)

  std::vector<std::string> face_lines;  ///< how the scanned face came out of the drawing; in notes as well

  // Registration
  AlignmentSummary alignment;
  struct SegmentSummary {
    int contour = 0;
    double from_mm = 0, to_mm = 0, rms_mm = 0;
    int iterations = 0, pairs = 0;
    bool from_data = true;
    std::string stop;
  };
  std::vector<SegmentSummary> segments;
  /// Of method projection: what its model found on one contour and what it left there.
  struct ProjectionSummary {
    int contour = 0;
    std::string model;  ///< "plane", "parabola", "spline"
    std::size_t points = 0;
    double height_rms_mm = 0, height_max_mm = 0;  ///< NaN: of a spline, which is the measure
    double across_rms_mm = 0, across_max_mm = 0;
    double scatter_mm = 0;  ///< of the scan points beside the contour about their smooth height; robust sigma
    /// Of a parabola whose axis the scan determines; CAD frame, z = alpha w^2 along the normal.
    struct Bending {
      double alpha_per_mm = 0, alpha_sd_per_mm = 0, axis_sd_rad = 0;
      Eigen::Vector3d axis_point_mm = Eigen::Vector3d::Zero(), axis = Eigen::Vector3d::UnitX();
    };
    std::optional<Bending> bending = std::nullopt;
  };
  std::vector<ProjectionSummary> projection;
  RefinementSummary refinement;  ///< empty unless the recipe asks for it
  std::vector<std::pair<std::string, double>>
      stage_residual_mm;            ///< "rigid", "subdivision": rms of the edge pairs
  double mean_strain_ratio = 0.0;   ///< mean in-surface strain along the contours, see strain_at_mid
  double face_strain_ratio = 0.0;   ///< the same on the scanned face, bending included
  double strain_limit_ratio = 0.0;  ///< the smallest strain that the scan's edge limit lets one see
  bool strain_at_mid = false;       ///< the thickness is known: mean_strain_ratio is the mid-surface's

  // Geometry for pictures, scan frame, local to cloud.offset_mm
  PointCloud cloud;                 ///< the scan as read (cleaned of non-finite points)
  std::vector<float> deviation_mm;  ///< one a point of `cloud`, after the rigid alignment; NaN: beyond reach
  TriangleMesh cad;                 ///< CAD frame
  std::vector<Contour> cad_contours;    ///< accepted, CAD frame
  std::vector<Contour> found_contours;  ///< found in the scan, scan frame local
  std::vector<Contour>
      dropped_contours;  ///< loops of the scan that were found and not used, scan frame local

  // Tool path
  ToolPath nominal_path;              ///< CAD frame
  Correction correction;              ///< scan frame local
  std::vector<std::string> refusals;  ///< all reasons of a refused run, correction.reasons included
  double edge_limit_mm = 0.0;         ///< E = 1 / (density x 50 mm), across the contour; NaN: role cut
  double surface_limit_mm = 0.0;      ///< sigma / sqrt(points within 10 mm)

  // The three results
  double surface_profile_mm = 0.0, contour_profile_mm = 0.0, max_correction_mm = 0.0;  ///< recipe [tolerance]
  DeviationStatistics as_scanned;  ///< (ii) shape after the rigid alignment
  DeviationStatistics
      pulled_back;  ///< (iii) found edge pulled back through the field, or the edge's own error
  Judged judged_as_scanned, judged_pulled_back;
  std::vector<ContourError> contour_errors;

  // Cell
  std::optional<TargetFrame> frame;      ///< of a cell with fixture targets; file coordinates of the scan
  double frame_max_residual_mm = 0.0;    ///< the cell's limit
  std::vector<RowUncertainty> robot_sd;  ///< one a corrected row, when correction and frame are good

  // Robot program
  bool program_written = false;  ///< only when ACCEPTED, a cell is given and the scanner's frame is known
  std::string program_note;      ///< why there is none, or its file names

  [[nodiscard]] bool accepted() const { return refusals.empty(); }
  /// A program was asked for, and fixture targets were to give the scanner's frame and did not.
  [[nodiscard]] bool frame_refused() const { return has_toolpath && frame && !frame->usable(); }
  /// Inspection verdict: pulled_back when clamped, as_scanned when free.
  [[nodiscard]] Verdict inspection_verdict() const {
    return state == "free" ? judged_as_scanned.verdict : judged_pulled_back.verdict;
  }
};

}  // namespace arris
