// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <string>
#include <vector>

namespace egocal::detail {

/// The files of a bag that rosbag2 has written as a folder.
struct BagFolder {
  struct Part {
    std::string name;  ///< as metadata.yaml names it, without folders
    std::string path;  ///< empty: the file is not there
  };
  /// The parts in order. If a packed file and its unpacked copy are there, only the copy.
  std::vector<Part> parts;
  std::vector<std::string> strangers;  ///< bags in the folder that metadata.yaml does not name
};

/// Finds the parts by names only. Without a metadata.yaml that names files, all bags in the folder are parts.
BagFolder look_into(const std::string& folder);

/// Whether this is the metadata.yaml of such a folder.
bool is_bag_metadata(const std::string& file);

}  // namespace egocal::detail
