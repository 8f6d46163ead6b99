// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A silence releases the poses that were held back while the clocks were compared. A process that was killed
// before or after it ends with the same numbers, to the bit.
#include <cstdint>
#include <memory>
#include <string>
#include <vector>

#include "saved_states.hpp"
#include "support/random_motion.hpp"

namespace egocal::services::test_saved_silences {
namespace {

class SavedSilences : public SavedStates, public ::testing::WithParamInterface<const char*> {
 protected:
  bus::Rig config() const {
    return bus::parse_rig(
        "[[sensor]]\nname = \"left\"\nchannel = \"L\"\n"
        "[[sensor]]\nname = \"right\"\nchannel = \"R\"\n" +
            std::string(GetParam()) + "[[pair]]\na = \"left\"\nb = \"right\"\ntime_offset = \"auto\"\n",
        "rig.toml");
  }
};

TEST_P(SavedSilences, EndWithTheSameBitsAfterKills) {
  int released = 0, killed = 0;
  for (std::uint64_t seed = 1; seed <= 4; ++seed) {
    testing::Random random(seed);
    std::filesystem::remove(file);
    Accumulation undisturbed(config());
    auto saved = std::make_unique<SavedState>(file, config());
    Accumulation accumulation = saved->restore();
    const auto feed = [&](const Input& input) {
      saved->note(input);
      accumulation.apply(input);
      undisturbed.apply(input);
    };
    const auto silence = [&] {
      if (accumulation.pairs()[0].can_release()) ++released;
      feed({Input::Kind::silent, 0});
    };
    for (const Message& message : drive("egocal.odometry_t", 300)) {
      feed({Input::Kind::message, message.channel, message.bytes});
      if (random.uniform() < 0.2) silence();
      if (random.uniform() < 0.02) {
        feed({Input::Kind::pause, 0});
        silence();
        feed({Input::Kind::resume, 0});
      }
      saved->save(accumulation);
      if (random.uniform() < 0.02) saved->snapshot(accumulation);
      if (random.uniform() > 0.02) continue;
      ++killed;
      saved.reset();
      saved = std::make_unique<SavedState>(file, config());
      accumulation = saved->restore();
      ASSERT_TRUE(saved->restored());
    }
    silence();
    for (std::uint16_t channel = 0; channel < 2; ++channel) feed({Input::Kind::give_up, channel});
    EXPECT_TRUE(pair_bits(accumulation) == pair_bits(undisturbed)) << seed;
    EXPECT_GT(accumulation.pairs()[0].state().seq, 50) << seed;
  }
  EXPECT_GE(released, 4) << "each drive has its first estimate once";
  EXPECT_GT(killed, 10);
}

INSTANTIATE_TEST_SUITE_P(Scale, SavedSilences, ::testing::Values("", "scale = \"auto\"\n"));

}  // namespace
}  // namespace egocal::services::test_saved_silences
