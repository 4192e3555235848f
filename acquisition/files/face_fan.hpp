#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

#include "acquisition/files/source.hpp"

namespace arris::files {

/// Turns the faces of a file into triangles: each polygon as a fan from its first corner.
class FaceFan {
 public:
  FaceFan(const Source& source, std::size_t points, Loaded& out)
      : source_(source), points_(points), out_(out) {}

  /// Room for that many faces; the caller has checked that the file can hold them.
  void expect(std::size_t faces) { out_.triangles.reserve(out_.triangles.size() + faces); }

  /// A corner of the face being read; refused when no point has that index.
  void corner(std::int64_t index) {
    if (index < 0 || static_cast<std::size_t>(index) >= points_) throw out_of_range(index);
    corners_.push_back(static_cast<std::int32_t>(index));
  }

  /// The face is complete.
  void close() {
    ++faces_;
    if (corners_.size() < 3) ++too_few_;
    for (std::size_t i = 2; i < corners_.size(); ++i)
      out_.triangles.push_back({corners_[0], corners_[i - 1], corners_[i]});
    corners_.clear();
  }

  /// After the last face: notes about what was left out.
  void finish() const;

 private:
  [[nodiscard]] Error out_of_range(std::int64_t index) const;

  const Source& source_;
  std::size_t points_;
  Loaded& out_;
  std::vector<std::int32_t> corners_;
  std::size_t faces_ = 0;
  std::size_t too_few_ = 0;
};

}  // namespace arris::files
