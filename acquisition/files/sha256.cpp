#include "acquisition/files/sha256.hpp"

#include <openssl/evp.h>

#include <array>
#include <memory>
#include <system_error>

#include "acquisition/files/mapped_file.hpp"
#include "acquisition/types/error.hpp"

namespace arris {

std::string sha256_hex(std::string_view bytes) {
  std::array<unsigned char, 32> digest{};
  unsigned int length = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &length, EVP_sha256(), nullptr) != 1 ||
      length != digest.size())
    throw Error(Fault::kBug, "libcrypto gives no SHA-256");
  static constexpr char kDigits[] = "0123456789abcdef";
  std::string hex;
  hex.reserve(2 * digest.size());
  for (const unsigned char byte : digest) {
    hex += kDigits[byte >> 4];
    hex += kDigits[byte & 15];
  }
  return hex;
}

std::string sha256_file(const std::filesystem::path& file) {
  std::error_code ignored;
  if (std::filesystem::is_regular_file(file, ignored) && std::filesystem::file_size(file, ignored) == 0)
    return sha256_hex({});
  return sha256_hex(files::MappedFile(file).bytes());
}

}  // namespace arris
