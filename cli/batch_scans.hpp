#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace arris {

/// A scan of a batch, and the name of its run folder.
struct BatchScan {
  std::filesystem::path file;  ///< as it was given, or folder / name
  std::string name;            ///< unique in the batch
};

/// The scans that the words of a command line stand for, in their order; each file once.
///   a file      itself, whether it is there or not: its run will say
///   a folder    the .ply .pcd .stl .off .xyz .xyzn .asc .pts files in it, by name; not those deeper or
///   hidden
///   @list.txt   a path a line, relative to the working folder; blank lines and those that begin with # not
///   leave_out   files in folders that are no scans: the recipe's drawing
///   throws      Error(kInput): a list that cannot be read, a folder without a scan, no scan at all
[[nodiscard]] std::vector<BatchScan> batch_scans(const std::vector<std::string>& words,
                                                 const std::vector<std::filesystem::path>& leave_out);

/// Names of run folders, one a file: the stem; where stems are alike the whole name ("part7.ply"); where
/// these are alike too, folders above before it ("monday_part7.ply"). The order of the files plays no part
/// unless even whole paths give one name, where a number follows. A name in `taken` is given to none.
[[nodiscard]] std::vector<std::string> run_names(const std::vector<std::filesystem::path>& files,
                                                 const std::vector<std::string>& taken);

}  // namespace arris
