// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// What pairing has accumulated outlives the process, to the bit.
#include <algorithm>
#include <utility>

#include "saved_states.hpp"
#include "support/random_motion.hpp"

namespace egocal::services::test_saved_state {
namespace {

/// Killed again and again; what was not saved is sent again, with some of what was.
TEST_F(SavedStates, GoOnWithTheSameBits) {
  for (const std::string type : {"egocal.odometry_t", "bot_core.pose_t"}) {
    const bus::Rig config = rig(type);
    const auto messages = drive(type, 300);
    Accumulation undisturbed(config);
    for (const Message& message : messages)
      undisturbed.apply({Input::Kind::message, message.channel, message.bytes});
    for (std::uint64_t seed = 1; seed <= 5; ++seed) {
      egocal::testing::Random random(seed);
      std::filesystem::remove(file);
      auto saved = std::make_unique<SavedState>(file, config);
      Accumulation accumulation = saved->restore();
      const auto feed = [&](const Input& input) {
        saved->note(input);
        accumulation.apply(input);
      };
      std::size_t on_disk = 0;
      for (std::size_t next = 0; next < messages.size(); ++next) {
        feed({Input::Kind::message, messages[next].channel, messages[next].bytes});
        if (random.uniform() < 0.2) {
          saved->save(accumulation);
          on_disk = next + 1;
        }
        if (random.uniform() < 0.01) saved->snapshot(accumulation), on_disk = next + 1;
        if (random.uniform() > 0.02) continue;
        saved.reset();  // killed: nothing is written at the end
        saved = std::make_unique<SavedState>(file, config);
        accumulation = saved->restore();
        ASSERT_TRUE(saved->restored()) << saved->refused();
        // what came before the new process was received, out of order
        std::size_t first_missing = messages.size();
        for (std::uint16_t k = 0; k < 2; ++k) {
          std::size_t missing = 0;
          for (std::size_t i = 0; i < messages.size(); ++i)
            if (messages[i].channel == k &&
                bus::utime_in(messages[i].bytes) == accumulation.complete_until(k))
              missing = i + 1;
          first_missing = std::min(first_missing, missing);
        }
        EXPECT_LE(first_missing, on_disk);
        for (std::size_t i = first_missing + 5; i < std::min(first_missing + 9, messages.size()); ++i)
          feed({Input::Kind::message, messages[i].channel, messages[i].bytes});
        next = first_missing - 1;
      }
      for (std::uint16_t k = 0; k < 2; ++k) feed({Input::Kind::give_up, k});
      EXPECT_TRUE(pair_bits(accumulation) == pair_bits(undisturbed)) << type << ", seed " << seed;
    }
  }
}

bus::Rig rig_without_scale() {
  return bus::parse_rig(
      "[[sensor]]\nname = \"left\"\nchannel = \"L\"\n"
      "[[sensor]]\nname = \"right\"\nchannel = \"R\"\nscale = \"auto\"\n"
      "[[pair]]\na = \"left\"\nb = \"right\"\n",
      "rig.toml");
}

TEST_F(SavedStates, KeepTheScale) {
  const bus::Rig config = rig_without_scale();
  const auto messages = drive("egocal.odometry_t", 500);
  Accumulation undisturbed(config);
  for (const Message& message : messages)
    undisturbed.apply({Input::Kind::message, message.channel, message.bytes});
  auto saved = std::make_unique<SavedState>(file, config);
  Accumulation accumulation = saved->restore();
  for (std::size_t next = 0; next < messages.size(); ++next) {
    const Input input{Input::Kind::message, messages[next].channel, messages[next].bytes};
    saved->note(input);
    accumulation.apply(input);
    if (next % 101 == 0) saved->snapshot(accumulation);
    saved->save(accumulation);
    if (next % 333 != 332) continue;
    saved.reset();  // killed
    saved = std::make_unique<SavedState>(file, config);
    accumulation = saved->restore();
    ASSERT_TRUE(saved->restored()) << saved->refused();
  }
  const auto scale = undisturbed.pairs()[0].scale_message();
  ASSERT_TRUE(scale);
  EXPECT_NEAR(scale->scale, 1, 0.01) << "the streams of this drive are in metres";
  const auto restored = accumulation.pairs()[0].scale_message();
  ASSERT_TRUE(restored);
  EXPECT_EQ(bus::encode(*restored), bus::encode(*scale));
  const auto problem = accumulation.pairs()[0].message();
  ASSERT_TRUE(problem);
  EXPECT_EQ(bus::encode(*problem), bus::encode(*undisturbed.pairs()[0].message()));
  EXPECT_EQ(problem->seq, scale->seq);
}

TEST_F(SavedStates, KeepWhatIsPausedAndReset) {
  const bus::Rig config = rig("egocal.odometry_t");
  write_state(config, 100);
  {
    SavedState saved(file, config);
    Accumulation accumulation = saved.restore();
    for (const Input::Kind kind : {Input::Kind::new_session, Input::Kind::pause}) {
      saved.note({kind, 0});
      accumulation.apply({kind, 0});
    }
    saved.save(accumulation);
  }
  SavedState saved(file, config);
  const Accumulation accumulation = saved.restore();
  EXPECT_TRUE(accumulation.pairs()[0].paused());
  EXPECT_EQ(accumulation.pairs()[0].session(), -1);
}

TEST_F(SavedStates, AClockThatIsSetBetweenDeathAndRestartCostsNothing) {
  for (const auto jump : {std::chrono::hours(5), std::chrono::hours(-5), std::chrono::hours(24 * 365 * 20)}) {
    write_state(rig("egocal.odometry_t"), 100);
    std::filesystem::last_write_time(file, std::filesystem::file_time_type::clock::now() - jump);
    SavedState saved(file, rig("egocal.odometry_t"));
    saved.restore();
    EXPECT_TRUE(saved.restored()) << saved.refused();
    std::filesystem::remove(file);
  }
}

}  // namespace
}  // namespace egocal::services::test_saved_state
