// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "offline/reading/lcm_ros_types.hpp"

#include <algorithm>
#include <bit>
#include <memory>
#include <vector>

namespace egocal::tools {

namespace {

struct Type;
using TypePointer = std::shared_ptr<const Type>;

/// What a field means to us.
enum class Role { none, seconds, nanoseconds, x, y, z, qw, qx, qy, qz, vx, vy, vz, wx, wy, wz };

struct Member {
  std::string name;
  std::string primitive;  ///< "int32_t", "double" or "string"; empty: a nested type
  TypePointer nested;
  int count = 0;                 ///< of a constant array; 0: a single value
  std::vector<Role> roles = {};  ///< of the values of a primitive
};

struct Type {
  std::string name;
  std::vector<Member> members;
};

TypePointer type(std::string name, std::vector<Member> members) {
  return std::make_shared<Type>(Type{std::move(name), std::move(members)});
}

/// LCM's hash of names and types of the members, as lcm-gen computes it.
class Hash {
 public:
  void add(int c) {
    const auto signed_value = static_cast<std::int64_t>(value_);
    value_ = (value_ << 8 ^ static_cast<std::uint64_t>(signed_value >> 55)) + static_cast<std::uint64_t>(c);
  }
  void add(const std::string& text) {
    add(static_cast<int>(text.size()));
    for (const char c : text) add(c);
  }
  std::uint64_t value() const { return value_; }

 private:
  std::uint64_t value_ = 0x12345678;
};

std::uint64_t fingerprint(const Type& type) {
  Hash own;
  std::uint64_t nested = 0;
  for (const Member& member : type.members) {
    own.add(member.name);
    if (member.primitive.empty())
      nested += fingerprint(*member.nested);
    else
      own.add(member.primitive);
    own.add(member.count > 0 ? 1 : 0);
    if (member.count > 0) {
      own.add(0);  // of a constant size
      own.add(std::to_string(member.count));
    }
  }
  const std::uint64_t sum = own.value() + nested;
  return std::rotl(sum, 1);
}

Member number(const std::string& name, Role role, const std::string& primitive = "double") {
  return {name, primitive, nullptr, 0, {role}};
}
Member text(const std::string& name) {
  return {name, "string", nullptr, 0, {}};
}
Member numbers(const std::string& name, std::vector<Role> roles, int count) {
  return {name, "double", nullptr, count, std::move(roles)};
}
Member nested(const std::string& name, TypePointer of) {
  return {name, "", std::move(of), 0, {}};
}

std::vector<TypePointer> known_types() {
  using enum Role;
  const auto xyz = [](Role a, Role b, Role c) {
    return std::vector<Member>{number("x", a), number("y", b), number("z", c)};
  };
  const TypePointer point = type("Point", xyz(x, y, z));
  const TypePointer vector = type("Vector3", xyz(none, none, none));
  const TypePointer quaternion =
      type("Quaternion", {number("x", qx), number("y", qy), number("z", qz), number("w", qw)});
  const TypePointer pose = type("Pose", {nested("position", point), nested("orientation", quaternion)});
  const TypePointer transform =
      type("Transform", {nested("translation", point), nested("rotation", quaternion)});
  const TypePointer twist = type("Twist", {nested("linear", vector), nested("angular", vector)});
  const TypePointer velocity = type("Twist", {nested("linear", type("Vector3", xyz(vx, vy, vz))),
                                              nested("angular", type("Vector3", xyz(wx, wy, wz)))});
  const TypePointer velocity_with =
      type("TwistWithCovariance", {nested("twist", velocity), numbers("covariance", {}, 36)});
  const TypePointer pose_with =
      type("PoseWithCovariance", {nested("pose", pose), numbers("covariance", {}, 36)});
  const TypePointer twist_with =
      type("TwistWithCovariance", {nested("twist", twist), numbers("covariance", {}, 36)});
  std::vector<TypePointer> types;
  for (const char* rest : {"nsec", "nanosec"})
    for (const bool with_seq : {true, false}) {
      const TypePointer time =
          type("Time", {number("sec", seconds, "int32_t"), number(rest, nanoseconds, "int32_t")});
      std::vector<Member> members;
      if (with_seq) members.push_back(number("seq", none, "int32_t"));
      members.push_back(nested("stamp", time));
      members.push_back(text("frame_id"));
      const TypePointer header = type("Header", members);
      types.push_back(type("nav_msgs.Odometry", {nested("header", header), text("child_frame_id"),
                                                 nested("pose", pose_with), nested("twist", twist_with)}));
      types.push_back(type("geometry_msgs.PoseStamped", {nested("header", header), nested("pose", pose)}));
      types.push_back(type("geometry_msgs.PoseWithCovarianceStamped",
                           {nested("header", header), nested("pose", pose_with)}));
      types.push_back(
          type("geometry_msgs.TransformStamped",
               {nested("header", header), text("child_frame_id"), nested("transform", transform)}));
      types.push_back(
          type("geometry_msgs.TwistStamped", {nested("header", header), nested("twist", velocity)}));
      types.push_back(type("geometry_msgs.TwistWithCovarianceStamped",
                           {nested("header", header), nested("twist", velocity_with)}));
    }
  const TypePointer dairlib_header = type(
      "dairlib.lcmt_ros_header", {number("seq", none, "int32_t"), number("timestamp_sec", seconds, "int32_t"),
                                  number("timestamp_nsec", nanoseconds, "int32_t"), text("frame_id")});
  types.push_back(type("dairlib.lcmt_ros_odometry",
                       {nested("header", dairlib_header), text("child_frame_id"),
                        numbers("pose_point", {x, y, z}, 3), numbers("pose_quat", {qw, qx, qy, qz}, 4),
                        numbers("twist_linear", {}, 3), numbers("twist_angular", {}, 3)}));
  return types;
}

/// Big-endian, as LCM sends.
class Reader {
 public:
  explicit Reader(bus::Bytes bytes) : bytes_(bytes) {}
  std::uint64_t bits(std::size_t size) {
    std::uint64_t value = 0;
    for (const std::byte byte : take(size)) value = value << 8 | std::to_integer<std::uint64_t>(byte);
    return value;
  }
  bus::Bytes take(std::size_t size) {
    ok_ = ok_ && size <= bytes_.size();
    if (!ok_) return {};
    const bus::Bytes taken = bytes_.first(size);
    bytes_ = bytes_.subspan(size);
    return taken;
  }
  bool ok() const { return ok_; }
  bool complete() const { return ok_ && bytes_.empty(); }

 private:
  bus::Bytes bytes_;
  bool ok_ = true;
};

void put(LcmRosPose& pose, Role role, double value) {
  if (role >= Role::x && role <= Role::z)
    pose.position[static_cast<int>(role) - static_cast<int>(Role::x)] = value;
  if (role >= Role::vx)
    pose.twist[static_cast<int>(role) - static_cast<int>(Role::vx)] = value;
  else if (role >= Role::qw)
    pose.quaternion[static_cast<int>(role) - static_cast<int>(Role::qw)] = value;
}

void read(Reader& from, const Type& type, LcmRosPose& pose) {
  for (const Member& member : type.members) {
    if (member.primitive.empty()) {
      read(from, *member.nested, pose);
    } else if (member.primitive == "string") {
      from.take(static_cast<std::size_t>(from.bits(4)));
    } else if (member.primitive == "int32_t") {
      const auto value = static_cast<std::int32_t>(static_cast<std::uint32_t>(from.bits(4)));
      if (member.roles[0] == Role::seconds) pose.time_us += std::int64_t{value} * 1'000'000;
      if (member.roles[0] == Role::nanoseconds) pose.time_us += (value + 500) / 1000;
    } else {
      for (int i = 0; i < std::max(1, member.count); ++i) {
        const double value = std::bit_cast<double>(from.bits(8));
        if (static_cast<std::size_t>(i) < member.roles.size())
          put(pose, member.roles[static_cast<std::size_t>(i)], value);
      }
    }
  }
}

}  // namespace

std::optional<LcmRosPose> decode_lcm_ros_pose(bus::Bytes bytes) {
  struct Known {
    std::uint64_t fingerprint;
    TypePointer type;
  };
  static const std::vector<Known> known = [] {
    std::vector<Known> all;
    for (const TypePointer& type : known_types()) all.push_back({fingerprint(*type), type});
    return all;
  }();
  Reader from(bytes);
  const std::uint64_t sent = from.bits(8);
  if (!from.ok()) return std::nullopt;
  for (const Known& candidate : known) {
    if (candidate.fingerprint != sent) continue;
    LcmRosPose pose;
    pose.type = candidate.type->name;
    pose.velocity = pose.type.find("Twist") != std::string::npos;
    read(from, *candidate.type, pose);
    if (from.complete()) return pose;
    return std::nullopt;
  }
  return std::nullopt;
}

}  // namespace egocal::tools
