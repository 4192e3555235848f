#pragma once

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "cli/key_table.hpp"

namespace arris {

/// Every choice for one part number, as the TOML file spells it: lengths in mm, angles in degrees. Paths are
/// already relative to the working folder. What each field means is said once, in recipe_keys() (arris recipe
/// print).
struct Recipe {
  struct Part {
    std::string number;
    std::filesystem::path cad;
    std::string cad_units;
    std::string cad_is = "scanned_face";
    std::optional<double> thickness_mm;
    std::string state = "clamped";
  };
  struct InitialPose {
    bool given = false;                 ///< the file has [scan.initial]
    std::vector<double> scan_from_cad;  ///< as written; initial_scan_from_cad() reads it
    double within_deg = 30.0;
  };
  struct Scan {
    std::string units;
    std::vector<double> seen_from;  ///< empty, or x, y, z in mm, scan frame
    double outlier_sigmas = 4.0;
    double voxel_mm = 0.0;
    std::filesystem::path edge_calibration;  ///< empty: where the scanner shows edges is not known
    InitialPose initial;
  };
  struct Contour {
    std::filesystem::path file;  ///< empty: found in the CAD
    std::vector<int> accept, reject;
    std::string role = "edge";
    double stock_mm = 0.0;
    std::string validation = "auto";
    double sharp_edge_deg = 30.0;
    double angle_gap_deg = 90.0;
    double disc_spacings_ratio = 2.0;
    double outsized_edge_ratio = 5.0;
    double min_length_mm = 0.0;
  };
  struct FromContour {
    bool given = false;  ///< the file has [toolpath.from_contour]
    double offset_mm = 0.0;
    double depth_mm = 0.0;
    double step_mm = 2.0;
    double chord_error_mm = 0.02;
    double tilt_deg = 0.0;
    double lead_deg = 0.0;
    double seam_mm = 0.0;
    bool reversed = false;
    double approach_mm = 0.0;
    double retract_mm = 0.0;
  };
  struct Toolpath {
    std::filesystem::path file;
    std::string process = "deburr";
    std::string face = "scanned";
    std::string spin = "least_turn";
    double feed_mm_s = 0.0;
    double path_reach_mm = 30.0;
    FromContour from_contour;
  };
  struct Subdivision {
    double corner_radius_max_mm = 80.0;
    double segment_length_max_mm = 80.0;
    double band_mm = 60.0;
    double overlap_ratio = 0.3;
    std::string match = "foot";
    std::string stability_points = "local";
    int stability_count = 60;
    double stability_distance_mm = 30.0;
    int max_iterations = 30;
    double stop_change_ratio = 1e-3;
    std::string blend = "sin2";
    std::string refine = "none";
  };
  struct Surface {
    double node_spacing_mm = 30.0;
    double strain_ratio = 3e-4;
    double bend_per_mm = 3e-4;
    double offset_sd_mm = 0.5;
  };
  struct Projection {
    std::string model = "spline";
    double distance_mm = 30.0;
    double max_residual_mm = 0.5;
  };
  struct Registration {
    std::string method = "surface";
    std::optional<double> min_seen_ratio;
    std::optional<double> max_unseen_mm;
    double max_sd_mm = 1.0;
    Subdivision subdivision;
    Surface surface;
    Projection projection;
  };
  struct Tolerance {
    double surface_profile_mm = 0.0;  ///< full width of the zone; 0: none stated, shown and not judged
    double contour_profile_mm = 0.0;
    double max_correction_mm = 20.0;
    double max_tilt_deg = 20.0;
    double max_step_ratio = 1.5;
  };
  struct Robot {
    std::string controller = "rapid";
  };

  int schema = 1;
  Part part;
  Scan scan;
  Contour contour;
  Toolpath toolpath;
  Registration registration;
  Tolerance tolerance;
  Robot robot;
  std::filesystem::path cell;  ///< [cell] file; empty: no cell, no program
};

/// The one table of keys, bound to `recipe`: what reading, printing, docs and tests know. Valid while
/// `recipe` lives.
[[nodiscard]] std::vector<Key> recipe_keys(Recipe& recipe);

/// A recipe with all that is wrong in it, line by line; problems empty: good.
struct RecipeRead {
  Recipe recipe;
  std::vector<ErrorText> problems;
};

/// Reads and checks text as if it stood in `file`.
[[nodiscard]] RecipeRead parse_recipe(const std::filesystem::path& file, const std::string& text);

/// Reads a recipe. Throws Error(kInput) when the file cannot be read, Error(kRecipe) with the first problem
/// in it.
[[nodiscard]] Recipe read_recipe(const std::filesystem::path& file);

/// Tables whose presence means something and that the recipe does not have.
[[nodiscard]] std::set<std::string> absent_tables(const Recipe& recipe);

/// The full TOML of a recipe: every key with its value, commented. Paths are written relative to `folder`.
[[nodiscard]] std::string print_recipe(const Recipe& recipe, const std::filesystem::path& folder = {});

/// What one unit of a file is in mm: "mm", "cm", "m", "inch".
[[nodiscard]] double unit_mm(const std::string& unit);

}  // namespace arris
