// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "egocal/io/pairs_file.hpp"

#include <cmath>

#include "egocal/error.hpp"
#include "egocal/io/whole_file.hpp"
#include "io/number_text.hpp"
#include "io/text.hpp"

namespace egocal {

std::vector<MotionPair> read_pairs(const std::string& file) {
  constexpr const char* names[] = {"rw", "rx", "ry", "rz", "dw", "dx", "dy", "dz"};
  std::vector<MotionPair> pairs;
  for (const detail::Line& line : detail::read_lines(file)) {
    const auto columns = detail::fields(line.text, line.text.find(',') != std::string::npos);
    if (columns.size() != 16)
      throw error_at(file, line.number, "",
                     "expected 16 fields (two dual quaternions), got " + std::to_string(columns.size()));
    Vector8d q[2];
    for (std::size_t i = 0; i < 16; ++i)
      q[i / 8][static_cast<int>(i % 8)] = detail::number(
          file, line.number,
          "field " + std::to_string(i + 1) + " (" + (i < 8 ? "a " : "b ") + names[i % 8] + ")", columns[i]);
    MotionPair pair;
    for (int side = 0; side < 2; ++side) {
      const DualQuaternion motion = DualQuaternion::from_vec(q[side]);
      const char* const field = side == 0 ? "a" : "b";
      if (!(std::abs(motion.real.norm() - 1) <= 0.01))
        throw error_at(file, line.number, field, "the real part is not of length 1");
      if (!(motion.dual.norm() <= 1e9)) throw error_at(file, line.number, field, "expected less than 1e9 m");
      if (std::abs(motion.real.dot(motion.dual)) > 0.01 * (1 + motion.dual.norm()))
        throw error_at(file, line.number, field, "real and dual part are not orthogonal: no rigid motion");
      (side == 0 ? pair.a : pair.b) = canonical_sign(normalized(motion));
    }
    pairs.push_back(pair);
  }
  return pairs;
}

void write_pairs(const std::string& file, const std::vector<MotionPair>& pairs) {
  std::string text = "# motions of a, then of b: w x y z real, w x y z dual [m]\n";
  for (const MotionPair& pair : pairs)
    for (const DualQuaternion* q : {&pair.a, &pair.b})
      for (int i = 0; i < 8; ++i) {
        detail::append_number(text, q->vec()[i]);
        text += q == &pair.b && i == 7 ? '\n' : ' ';
      }
  write_whole_file(file, text);
}

}  // namespace egocal
