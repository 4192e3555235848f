#pragma once

#include <filesystem>

#include "acquisition/types/error.hpp"

namespace arris {

/// Runs a step that works on the scan. The rooms below know no file names: an error of the input that does
/// not say where it is lies in this file.
template <class Step>
auto in_scan(const std::filesystem::path& scan, const Step& step) {
  try {
    return step();
  } catch (const Error& error) {
    if (error.fault() != Fault::kInput || !error.text().where.empty()) throw;
    ErrorText text = error.text();
    text.where = scan.string();
    throw Error(error.fault(), text);
  }
}

}  // namespace arris
