#include "acquisition/files/lzf.hpp"

#include <cstring>

namespace arris::files {

bool unpack_lzf(std::string_view packed, std::span<char> out) {
  const auto* p = reinterpret_cast<const unsigned char*>(packed.data());
  const auto* const end = p + packed.size();
  std::size_t at = 0;
  while (p < end) {
    const std::size_t control = *p++;
    if (control < 32) {  // control + 1 bytes as they are
      const std::size_t length = control + 1;
      if (length > static_cast<std::size_t>(end - p) || length > out.size() - at) return false;
      std::memcpy(out.data() + at, p, length);
      p += length;
      at += length;
      continue;
    }
    std::size_t length = control >> 5;  // a match: length + 2 bytes from `back` bytes before
    if (length == 7) {
      if (p == end) return false;
      length += *p++;
    }
    if (p == end) return false;
    const std::size_t back = ((control & 31) << 8) + *p++ + 1;
    length += 2;
    if (back > at || length > out.size() - at) return false;
    for (std::size_t i = 0; i < length; ++i, ++at) out[at] = out[at - back];  // may overlap itself
  }
  return at == out.size();
}

}  // namespace arris::files
