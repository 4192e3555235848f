#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "acquisition/contour_extract.hpp"

namespace arris {

/// One contour of a file and what the operator decided about it.
struct ChosenContour {
  Contour contour;        ///< coordinates of the file, mm
  bool accepted = false;  ///< false: rejected
};

/// The operator's choice, made by looking at one file (a scan or a mesh): it holds for those bytes alone.
struct ContourChoice {
  std::string file;    ///< name, without folder
  std::string sha256;  ///< of the file
  double to_mm = 1.0;  ///< what one unit of the file is; the points below are mm
  std::vector<ChosenContour> contours;

  [[nodiscard]] std::vector<Contour> accepted() const;
};

/// Marks the contours with the ids as accepted, all others as rejected; adds offset_mm to their points.
/// Throws Error(kUsage) for an id that is not among them, naming those that are.
[[nodiscard]] ContourChoice choose(const ContourSet& contours, const std::vector<int>& accepted_ids,
                                   const Eigen::Vector3d& offset_mm);

/// The choice as JSON; numbers rounded to 1e-6.
[[nodiscard]] std::string contour_choice_json(const ContourChoice& choice);

/// Reads a choice. Throws Error(kInput) when it cannot be read or is no choice of this program.
[[nodiscard]] ContourChoice read_contour_choice(const std::filesystem::path& file);

/// The same, refused when it was made for another file than the one with this hash.
[[nodiscard]] ContourChoice read_contour_choice_for(const std::filesystem::path& file,
                                                    const std::string& sha256);

}  // namespace arris
