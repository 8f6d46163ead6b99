// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// The verdict over real LCM: pairing and diagnosis as processes, `egocal listen` beside them.
#include <csignal>
#include <nlohmann/json.hpp>

#include "egocal/bus/verdict.hpp"
#include "processes.hpp"
#include "support/mistakes.hpp"
#include "support/planar_drive.hpp"

namespace egocal::test_verdict {
namespace {

using namespace std::chrono_literals;
using test::bin;
using test::ChildProcess;
using test::drive;
using test::events;
using test::Processes;
using ::testing::HasSubstr;

class LiveVerdict : public Processes {
 protected:
  LiveVerdict() {
    loop->subscribe<verdict_t>(bus::verdict_channel("left", "right"),
                               [this](const verdict_t& message, const bus::Arrival&) {
                                 EXPECT_TRUE(bus::to_verdict(message)) << bus::to_verdict(message).reason;
                                 verdict = message;
                               });
  }
  bool judged() {
    return until([&] { return verdict && problem && verdict->seq == problem->seq; });
  }
  std::string listened(const std::string& arguments, int expected) {
    const std::string out = folder / "listened";
    ChildProcess listen({"/bin/sh", "-c", bin + "/egocal listen --lcm-url '" + url + "' " + arguments}, out);
    // what it listens to
    const auto sent = events(drive(600));
    std::size_t next = 0;
    int code = -1;
    for (int i = 0; i < 400 && code < 0; ++i) {
      for (int k = 0; k < 2 && next < sent.size(); ++k, ++next)
        loop->publish(channel(sent[next].side), bus::to_message(sent[next].pose, sent[next].seq));
      loop->run_once(0ms);
      code = listen.wait(20ms);
    }
    EXPECT_EQ(code, expected);
    std::ifstream in(out);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  std::optional<verdict_t> verdict;
};

TEST_F(LiveVerdict, NamesAMistakeAndOutlivesAKill) {
  start("egocal-pairing");
  start("egocal-diagnosis");
  std::vector<Trajectory> trajectories = drive(300);
  trajectories[1] = testing::lengthened(trajectories[1], 0.37);
  play(events(trajectories));
  ASSERT_TRUE(judged());
  EXPECT_EQ(verdict->verdict, "contradictory") << verdict->reason;
  ASSERT_GT(verdict->n_findings, 0);
  EXPECT_EQ(verdict->findings[0].code, "scale");
  EXPECT_EQ(verdict->session, problem->session);
  EXPECT_EQ(counter("egocal-diagnosis", "lost"), 0);

  processes.at("egocal-diagnosis").signal(SIGKILL);
  processes.erase("egocal-diagnosis");
  until([] { return false; }, 200ms);  // what it sent before is in the receive buffer
  verdict.reset();
  start("egocal-diagnosis");
  ASSERT_TRUE(judged()) << "it judges again, by what pairing still knows";
  EXPECT_EQ(verdict->fit.poses, 0) << "it has heard no pose itself";
}

/// Of streams in two dimensions. The reason said so, while the screen and the export had roll and pitch known
/// to a millionth of a degree.
TEST_F(LiveVerdict, WhatBothStreamsAssumeIsShownAsUnknown) {
  for (const char* program : {"egocal-pairing", "egocal-diagnosis", "egocal-global", "egocal-fast"})
    start(program);
  const std::string bus = " --rig " + rig_file + " --lcm-url '" + url + "'", watched = folder / "watched",
                    exported = folder / "exported";
  ChildProcess monitor({"/bin/sh", "-c", "exec " + bin + "/egocal-monitor --json" + bus}, watched);
  const testing::PlanarDrive planar = testing::planar_drive(1, 0.002, 0);
  std::vector<Trajectory> trajectories{planar.a, planar.b};
  for (Trajectory& trajectory : trajectories)
    for (StampedPose& pose : trajectory) pose.time_us += 1'600'000'000'000'000;
  play(events(trajectories));
  ASSERT_TRUE(judged());
  EXPECT_NE(verdict->verdict, "good") << verdict->reason;
  EXPECT_THAT(verdict->observable, ::testing::ElementsAre(1, 1, 0, 0, 0, 1));

  const auto answer = [&] {
    nlohmann::json found;
    std::ifstream in(watched);
    for (std::string line; std::getline(in, line);)
      if (line.starts_with("{") && line.ends_with("}")) found = nlohmann::json::parse(line)["pairs"][0];
    return found;
  };
  ASSERT_TRUE(until([&] {
    const nlohmann::json shown = answer();
    return shown.is_object() && shown.value("verdict_seq", 0) == verdict->seq;
  }));
  EXPECT_EQ(answer()["answer"]["observable"], nlohmann::json({true, true, false, false, false, true}));
  EXPECT_TRUE(answer()["answer"]["stddev"][3].is_null());
  EXPECT_LT(answer()["answer"]["stddev"][5], 0.1);

  ChildProcess exporting(
      {"/bin/sh", "-c", "exec " + bin + "/egocal export --format json" + bus + " --out " + exported},
      folder / "said");
  ASSERT_TRUE(until([&] { return exporting.wait(0ms) >= 0; }));
  std::ifstream in(exported);
  const nlohmann::json written = nlohmann::json::parse(in);
  EXPECT_EQ(written["not_observable"], nlohmann::json({"z", "roll", "pitch"})) << written.dump(2);
}

TEST_F(LiveVerdict, ListenSaysWhatIsHeardAndWhatIsMissed) {
  EXPECT_THAT(listened(rig_file + " --seconds 4", 0), HasSubstr("left: ODO_LEFT, egocal.odometry_t, "));
  const std::string other = folder / "other.toml";
  std::ifstream in(rig_file);
  std::string rig{std::istreambuf_iterator<char>(in), {}};
  rig.replace(rig.find("ODO_RIGHT"), 9, "ODO_WRONG");
  std::ofstream(other) << rig;
  const std::string said = listened(other + " --seconds 4", 1);
  EXPECT_THAT(said, HasSubstr("right: ODO_WRONG, nothing received; received instead: "
                              "ODO_RIGHT (egocal.odometry_t, "));
}

}  // namespace
}  // namespace egocal::test_verdict
