// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <string>
#include <string_view>

#include "egocal/io/recording.hpp"
#include "io/bytes/byte_source.hpp"

namespace egocal::detail {

/// What COLMAP writes at the beginning of images.txt.
inline constexpr std::string_view colmap_magic = "# Image list with two lines of data per image";

/// The registered images of a COLMAP model (images.txt) as one stream: two lines an image, of which the first
/// holds IMAGE_ID QW QX QY QZ TX TY TZ CAMERA_ID NAME. The poses in the file are world-to-camera; they are
/// inverted here. The time of an image is the last number in its name: a time where it is as large as one,
/// else the number of a frame at the given rate. Images come in the order of their times, as COLMAP's own
/// order means nothing; all poses are kept in memory for that.
class ColmapImages : public Recording {
 public:
  /// Throws Error for a rate or a file of times that does not fit.
  ColmapImages(std::unique_ptr<ByteSource> source, const ReadOptions& options);

  std::string format() const override { return "COLMAP images"; }
  bool has_scale() const override { return false; }
  void read(const std::string& topic, const TakePose& take) override;
  std::vector<std::string> unused(const ReadOptions& options) const override;

 private:
  std::unique_ptr<ByteSource> source_;
  double rate_ = 10;  ///< of images whose names hold numbers of frames [Hz]
  bool rate_given_ = false;
  bool times_in_names_ = false;  ///< of the last pass
  bool read_before_ = false;
};

}  // namespace egocal::detail
