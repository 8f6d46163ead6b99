// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "samples/shared_poses.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

#include "egocal/geometry/pose.hpp"

namespace egocal::detail {

namespace {

/// Poses that differ by less are one pose [rad, parts of the length]: files of six digits round by as much,
/// an arm is not that repeatable, and samples of different poses are thousands of times further apart.
constexpr double one_pose = 3e-6;

struct Place {
  QuaternionVector rotation;
  Eigen::Vector3d position;  ///< in parts of the length
  double key = 0;            ///< poses that are one have the same to rounding, others hardly ever
};

Place place_of(const DualQuaternion& pose, double length) {
  Place place;
  place.rotation = pose.real;
  place.position = 2 * quaternion_product(pose.dual, quaternion_conjugate(pose.real)).tail<3>() / length;
  // any direction that no grid of poses follows; the magnitude, as q and -q are one rotation
  place.key = std::abs(place.rotation.dot(QuaternionVector(0.618, -0.367, 0.271, 0.641))) +
              place.position.dot(Eigen::Vector3d(0.577, -0.291, 0.763));
  return place;
}

bool alike(const Place& x, const Place& y) {
  return (x.position - y.position).cwiseAbs().maxCoeff() < one_pose &&
         std::min((x.rotation - y.rotation).cwiseAbs().maxCoeff(),
                  (x.rotation + y.rotation).cwiseAbs().maxCoeff()) < one_pose;
}

/// Sets of samples that grow together; a set is called by its first sample.
class Unions {
 public:
  explicit Unions(std::size_t size) : parents_(size) {
    std::iota(parents_.begin(), parents_.end(), std::size_t{0});
  }
  std::size_t first_of(std::size_t i) {
    while (parents_[i] != i) i = parents_[i] = parents_[parents_[i]];
    return i;
  }
  void join(std::size_t i, std::size_t j) {
    const auto [first, second] = std::minmax({first_of(i), first_of(j)});
    parents_[second] = first;
  }

 private:
  std::vector<std::size_t> parents_;
};

void join_alike(const std::vector<Place>& places, Unions& unions) {
  std::vector<std::size_t> order(places.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    return places[i].key == places[j].key ? i < j : places[i].key < places[j].key;
  });
  constexpr double window = 8 * one_pose;  // the key is a sum of seven numbers, each below 1 times its own
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < order.size(); ++j) {
      if (places[order[j]].key - places[order[i]].key > window) break;
      if (!alike(places[order[i]], places[order[j]])) continue;
      unions.join(order[i], order[j]);
      break;  // the next one is joined to this one's partner
    }
}

}  // namespace

std::vector<std::size_t> units_of(std::span<const PoseSample> samples, double length) {
  Unions unions(samples.size());
  for (DualQuaternion PoseSample::*const side : {&PoseSample::a, &PoseSample::b}) {
    std::vector<Place> places;
    places.reserve(samples.size());
    for (const PoseSample& sample : samples) places.push_back(place_of(sample.*side, length));
    join_alike(places, unions);
  }
  std::vector<std::size_t> numbers(samples.size());
  std::size_t next = 0;
  for (std::size_t i = 0; i < samples.size(); ++i) {
    const std::size_t first = unions.first_of(i);
    numbers[i] = first == i ? next++ : numbers[first];
  }
  return numbers;
}

}  // namespace egocal::detail
