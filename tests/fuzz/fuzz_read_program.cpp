// Any bytes are a robot program or one Error; never a crash, a hang or a number that is not finite. The first
// byte chooses the language; the rest is the file.

#include <cmath>
#include <cstdint>
#include <stdexcept>
#include <string>
#include <string_view>

#include "acquisition/types/error.hpp"
#include "toolpath/robot/read_rapid.hpp"
#include "toolpath/robot/read_vplus.hpp"

namespace {

void need(bool holds, const char* what) {
  if (!holds) throw std::logic_error(what);
}

void check(const arris::Reading& reading, std::size_t size) {
  need(!reading.name.empty(), "a program has a name");
  need(reading.hashed_text.size() <= size, "what is hashed is the text or less");
  for (const arris::ReadEvent& event : reading.events) {
    const auto* move = std::get_if<arris::ReadMove>(&event);
    if (move == nullptr) continue;
    double length2 = 0.0;
    for (const double part_mm : move->pose.xyz_mm) need(std::isfinite(part_mm), "positions are finite");
    for (const double part : move->pose.quat_wxyz) length2 += part * part;
    need(std::abs(length2 - 1.0) < 1e-5, "orientations are unit quaternions");
    need(move->speed_mm_s > 0.0, "speeds are above 0");
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  if (size < 1) return 0;
  const std::string_view text(reinterpret_cast<const char*>(data) + 1, size - 1);
  try {
    check((data[0] & 1) != 0 ? arris::read_vplus(text, "a.v2") : arris::read_rapid(text, "a.mod"),
          text.size());
  } catch (const arris::Error& error) {
    need(error.fault() == arris::Fault::kInput, "what is wrong with a file is an input error");
    need(std::string_view(error.what()).find('\n') == std::string_view::npos, "an error is one line");
  }
  return 0;
}
