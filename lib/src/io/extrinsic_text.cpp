// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/extrinsic_text.hpp"

#include "io/extrinsic/words.hpp"

namespace egocal {

namespace {

struct Writer {
  ExtrinsicFormat format;
  std::string_view name;
  std::string (*write)(const detail::ExtrinsicWords&);
};
constexpr Writer writers[] = {
    {ExtrinsicFormat::yaml, "yaml", detail::yaml_text},
    {ExtrinsicFormat::json, "json", detail::json_text},
    {ExtrinsicFormat::ros, "ros", detail::ros_text},
    {ExtrinsicFormat::ros_launch, "ros-launch", detail::ros_launch_text},
    {ExtrinsicFormat::urdf, "urdf", detail::urdf_text},
    {ExtrinsicFormat::kalibr, "kalibr", detail::kalibr_text},
    {ExtrinsicFormat::autoware, "autoware", detail::autoware_text},
    {ExtrinsicFormat::lio_sam, "lio-sam", detail::lio_sam_text},
    {ExtrinsicFormat::opencv, "opencv", detail::opencv_text},
    {ExtrinsicFormat::matrix, "matrix", detail::matrix_text},
};

}  // namespace

std::string_view to_string(ExtrinsicFormat format) {
  for (const Writer& writer : writers)
    if (writer.format == format) return writer.name;
  return "";
}

std::optional<ExtrinsicFormat> extrinsic_format_from_name(std::string_view text) {
  for (const Writer& writer : writers)
    if (writer.name == text) return writer.format;
  return std::nullopt;
}

std::vector<std::string> extrinsic_format_names() {
  std::vector<std::string> names;
  for (const Writer& writer : writers) names.emplace_back(writer.name);
  return names;
}

bool is_frame_name(const std::string& name) {
  return detail::frame_name(name) == name;
}

std::string extrinsic_text(const NamedExtrinsic& extrinsic, ExtrinsicFormat format) {
  const detail::ExtrinsicWords words(extrinsic);
  for (const Writer& writer : writers)
    if (writer.format == format) return writer.write(words);
  return "";
}

}  // namespace egocal
