#include "acquisition/files/face_fan.hpp"

namespace arris::files {

void FaceFan::finish() const {
  if (too_few_ > 0)
    out_.notes.push_back(std::to_string(too_few_) + " of " + std::to_string(faces_) +
                         " faces left out: fewer than 3 corners");
}

Error FaceFan::out_of_range(std::int64_t index) const {
  return bad_file(source_, "a face uses a point that does not exist", "face " + std::to_string(faces_ + 1),
                  "index " + std::to_string(index),
                  points_ == 0 ? "no index: the file has no points" : "0 to " + std::to_string(points_ - 1),
                  "export the mesh again");
}

}  // namespace arris::files
