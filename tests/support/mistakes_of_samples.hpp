// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What users do to right sets of still poses before they calibrate with them.
#pragma once

#include <algorithm>
#include <cstddef>
#include <functional>
#include <numbers>
#include <string>
#include <vector>

#include "arm_samples.hpp"

namespace egocal::testing {

using Samples = std::vector<PoseSample>;

struct SampleMistake {
  std::string name;
  std::string code;  ///< of the finding that names it; empty: none has to
  std::function<void(Samples&)> make;
};

/// A mistake in each pose of one list.
inline std::function<void(Samples&)> of_each(DualQuaternion PoseSample::*list,
                                             const std::function<Pose(const Pose&)>& change) {
  return [list, change](Samples& samples) {
    for (PoseSample& sample : samples)
      sample.*list = canonical_sign(to_dual_quaternion(change(to_pose(sample.*list))));
  };
}

/// The pose in a left-handed world and body: y is on the other side.
inline Pose left_handed(const Pose& pose) {
  const Eigen::Quaterniond& q = pose.rotation;
  const Eigen::Vector3d& t = pose.translation;
  return {Eigen::Quaterniond(q.w(), -q.x(), q.y(), -q.z()), {t.x(), -t.y(), t.z()}};
}

inline std::vector<SampleMistake> mistakes_of_samples() {
  const Pose slip{rotation_exp({0, 3 * std::numbers::pi / 180, 0}), {0.01, 0, 0}};
  const auto inverse_pose = [](const Pose& pose) { return inverse(pose); };
  const auto in_millimetres = [](const Pose& pose) { return Pose{pose.rotation, 1000 * pose.translation}; };
  const auto exchanged = [](const Pose& pose) {
    const Eigen::Vector3d& t = pose.translation;
    return Pose{pose.rotation, {t.y(), t.x(), t.z()}};
  };
  const auto scalar_first = [](const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    return Pose{Eigen::Quaterniond(q.z(), q.w(), q.x(), q.y()), pose.translation};
  };
  return {{"none", "", [](Samples&) {}},
          {"a in left-handed axes", "axes_a", of_each(&PoseSample::a, left_handed)},
          {"b in left-handed axes", "axes_b", of_each(&PoseSample::b, left_handed)},
          {"x and y of b exchanged", "axes_b", of_each(&PoseSample::b, exchanged)},
          {"a inverted", "inverted_a", of_each(&PoseSample::a, inverse_pose)},
          {"b inverted", "inverted_b", of_each(&PoseSample::b, inverse_pose)},
          {"both inverted", "inverted_both",
           [=](Samples& samples) {
             of_each(&PoseSample::a, inverse_pose)(samples);
             of_each(&PoseSample::b, inverse_pose)(samples);
           }},
          {"order of b", "quaternion_order_b", of_each(&PoseSample::b, scalar_first)},
          {"b in millimetres", "units", of_each(&PoseSample::b, in_millimetres)},
          {"camera slips by 3 deg and 1 cm in the middle", "mount_moved",
           [=](Samples& samples) {
             for (std::size_t i = samples.size() / 2; i < samples.size(); ++i)
               samples[i].b = samples[i].b * to_dual_quaternion(slip);
           }},
          {"b a row late", "", [](Samples& samples) {
             for (std::size_t i = samples.size() - 1; i > 0; --i) samples[i].b = samples[i - 1].b;
           }}};
}

}  // namespace egocal::testing
