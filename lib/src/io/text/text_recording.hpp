// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "egocal/error.hpp"
#include "egocal/io/checked_pose.hpp"
#include "egocal/io/recording.hpp"
#include "egocal/io/twist_integrator.hpp"
#include "io/bytes/byte_source.hpp"
#include "io/text/angle_unit.hpp"
#include "io/text/layout.hpp"

namespace egocal::detail {

struct TextRows;

/// A trajectory as text: one stream without a name. A row that makes no sense is an Error; only a last row
/// that is cut off, rows with NaN and rows of a table with empty fields are counted and skipped.
class TextRecording : public Recording {
 public:
  TextRecording(std::unique_ptr<ByteSource> source, ReadOptions options);

  std::string format() const override { return layout_.format; }
  void read(const std::string& topic, const TakePose& take) override;
  std::vector<std::string> unused(const ReadOptions& options) const override;

 private:
  void find_layout();
  void find_angle_unit();
  void read_rows(TextRows& rows, const TakePose& take);
  AngleUnit unit_by_rows(const std::vector<Quantity>& angles);
  double seconds_of_row(const TextRows& rows) const;
  Error unit_of_angles_needed(const std::vector<Quantity>& angles) const;
  bool may_end_in_a_cut_number(const TextRows& rows) const;
  std::optional<StampedPose> pose_of_row(const TextRows& rows);
  std::int64_t time_of_row(const TextRows& rows) const;
  void check_last_row(const TextRows& rows) const;
  DualQuaternion pose_of_matrix(const TextRows& rows) const;
  CheckedPose pose_of_columns(const TextRows& rows);
  std::optional<DualQuaternion> pose_of_twist(const TextRows& rows, std::int64_t time_us);
  double value(const TextRows& rows, std::size_t index) const;
  /// The value of a quantity in m, rad, m/s. in_si: of a unit that is not given.
  double value(const TextRows& rows, Quantity quantity, double in_si = 1) const;
  double angle(const TextRows& rows, Quantity quantity) const;

  std::unique_ptr<ByteSource> source_;
  ReadOptions options_;
  TextLayout layout_;
  std::vector<std::int64_t> times_;  ///< of the file of times
  double rate_ = 10;                 ///< of rows without times [Hz]
  double angle_in_si_ = 1;           ///< of angles without a unit
  bool read_before_ = false;
  TwistIntegrator integrator_;          ///< of a table with velocities
  std::optional<Pose> T_earth_origin_;  ///< local frame of the first geodetic position
};

}  // namespace egocal::detail
