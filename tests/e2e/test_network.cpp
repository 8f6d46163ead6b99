// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
// A network that goes and comes back, hostile datagrams, and LCM's own programs beside ours.
#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/stat.h>

#include <algorithm>
#include <cstdlib>
#include <iterator>
#include <utility>

#include "processes.hpp"

namespace egocal::test_network {
namespace {

using namespace std::chrono_literals;
using test::bin;
using test::ChildProcess;
using test::drive;
using test::Event;
using test::events;
using test::Processes;

class Network : public Processes {
 protected:
  ~Network() override { set_route(true); }
  /// The namespace is the test's own: no other network is touched.
  static void set_route(bool there) {
    const char* command = there ? "ip route replace 224.0.0.0/4 dev lo" : "ip route del 224.0.0.0/4 dev lo";
    EXPECT_EQ(std::system(command), 0);
  }
  bool running(const std::string& process) {
    return ::kill(processes.at(process).pid(), 0) == 0 && processes.at(process).wait(0ms) == -1;
  }
  std::string output(const std::string& process) const {
    std::ifstream in(folder / (process + ".log"));
    return {std::istreambuf_iterator<char>(in), {}};
  }
};

TEST_F(Network, ThatIsAwayIsWaitedForAndNothingIsForgotten) {
  const std::vector<std::string> all{"egocal-pairing", "egocal-fast", "egocal-global"};
  for (const std::string& process : all) start(process);
  const auto trajectories = drive(200);
  const auto poses = events(trajectories);
  play({poses.begin(), poses.begin() + 200});
  ASSERT_TRUE(answered("egocal-fast"));

  set_route(false);
  // heartbeats cannot be sent: each process states it once
  ASSERT_TRUE(until([&] {
    return std::all_of(all.begin(), all.end(), [&](const std::string& process) {
      return output(process).find("waiting for the network") != std::string::npos;
    });
  }));
  for (const std::string& process : all) EXPECT_TRUE(running(process)) << process;

  set_route(true);
  for (const std::string& process : all) {
    EXPECT_TRUE(until([&] { return counter(process, "not sent") > 0; })) << process;
    EXPECT_TRUE(running(process)) << process;
    EXPECT_NE(output(process).find("the network is back"), std::string::npos) << process;
  }
  play({poses.begin() + 200, poses.end()});
  ASSERT_TRUE(until([&] { return problem->matched == 199; }));
  expect_statistics(offline(trajectories));
  EXPECT_TRUE(answered("egocal-fast"));
}

// Without numbers a receiver cannot tell that a pose is missing.
TEST_F(Network, ThatIsAwayStopsThePlayer) {
  write_rig("bot_core.pose_t");
  const auto trajectories = drive(200);
  const std::string log = folder / "drive.log";
  {
    bus::LogWriter writer(log);
    for (const Event& event : events(trajectories))
      writer.write(event.pose.time_us, channel(event.side), bus::encode(bus::to_pose_message(event.pose)));
    writer.close();
  }
  start("egocal-pairing");
  processes.emplace("egocal-player",
                    ChildProcess({bin + "/egocal-player", log, "--speed", "5", "--lcm-url", url},
                                 folder / "egocal-player.log"));
  ASSERT_TRUE(until([&] { return problem && problem->matched > 40; }));
  set_route(false);
  until([] { return false; }, 4s);
  EXPECT_LT(problem->matched, 199);
  set_route(true);
  EXPECT_TRUE(until([&] { return problem->matched == 199; })) << problem->matched;
  expect_statistics(offline(trajectories));
  EXPECT_EQ(processes.at("egocal-player").wait(patience), 0);
}

TEST_F(Network, ThatIsAwayAtTheStartIsWaitedFor) {
  set_route(false);
  processes.emplace("egocal-pairing",
                    ChildProcess({bin + "/egocal-pairing", "--rig", rig_file, "--lcm-url", url},
                                 folder / "egocal-pairing.log"));
  ASSERT_TRUE(
      until([&] { return output("egocal-pairing").find("waiting for the network") != std::string::npos; }));
  EXPECT_TRUE(running("egocal-pairing"));
  set_route(true);
  EXPECT_TRUE(until([&] { return statuses.contains("egocal-pairing"); }));
  const auto poses = events(drive(50));
  play(poses);
  EXPECT_TRUE(until([&] { return problem && problem->matched == 49; }));
}

TEST_F(Network, CommandsThatDoOneThingFailInOneLineWithoutIt) {
  set_route(false);
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"tell", "egocal-fast", "pause", "--lcm-url", url},
        std::vector<std::string>{"export", "--rig", rig_file, "--lcm-url", url}}) {
    std::vector<std::string> arguments{bin + "/egocal"};
    arguments.insert(arguments.end(), command.begin(), command.end());
    ChildProcess child(arguments, folder / (command[0] + ".log"));
    EXPECT_EQ(child.wait(patience), 1) << command[0];
    const std::string text = output(command[0]);
    EXPECT_NE(text.find("no multicast"), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;
  }
}

// file://FILE?mode=w is one of LCM's URLs: it overwrote any file that the user may write.
TEST_F(Network, UrlsOfFilesAreRefusedBeforeTheyAreOpened) {
  const std::string victim = folder / "victim";
  std::ofstream(victim) << "keep me";
  for (const std::vector<std::string>& command :
       {std::vector<std::string>{"egocal", "tell", "egocal-fast", "pause"},
        std::vector<std::string>{"egocal", "export", "--rig", rig_file},
        std::vector<std::string>{"egocal-pairing", "--rig", rig_file},
        std::vector<std::string>{"egocal-monitor", "--once", "--rig", rig_file}}) {
    std::vector<std::string> arguments{command};
    arguments[0] = bin + "/" + command[0];
    arguments.insert(arguments.end(), {"--lcm-url", "file://" + victim + "?mode=w"});
    ChildProcess child(arguments, folder / "refused.log");
    const int code = child.wait(patience);
    EXPECT_TRUE(code == 1 || code == 2) << command[0] << ": " << code;
  }
  EXPECT_EQ(std::filesystem::file_size(victim), 7U);
}

/// A socket that sends any bytes to the bus.
class RawSender {
 public:
  explicit RawSender(std::uint16_t port) : fd_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
    to_.sin_family = AF_INET;
    to_.sin_port = htons(port);
    inet_pton(AF_INET, "239.255.76.67", &to_.sin_addr);
    const unsigned char ttl = 0;
    setsockopt(fd_, IPPROTO_IP, IP_MULTICAST_TTL, &ttl, sizeof ttl);
  }
  ~RawSender() { close(fd_); }
  RawSender(const RawSender&) = delete;
  RawSender& operator=(const RawSender&) = delete;

  void send(const std::string& bytes) const {
    EXPECT_EQ(sendto(fd_, bytes.data(), bytes.size(), 0, reinterpret_cast<const sockaddr*>(&to_), sizeof to_),
              static_cast<ssize_t>(bytes.size()));
  }

 private:
  int fd_;
  sockaddr_in to_{};
};

std::string big_endian(std::uint32_t value, int bytes) {
  std::string text;
  for (int shift = 8 * (bytes - 1); shift >= 0; shift -= 8) text += static_cast<char>(value >> shift & 0xff);
  return text;
}

std::string fragment(std::uint32_t size, std::uint32_t offset, std::uint32_t number,
                     const std::string& data) {
  return big_endian(0x4c433033, 4) + big_endian(77, 4) + big_endian(size, 4) + big_endian(offset, 4) +
         big_endian(number, 2) + big_endian(3, 2) + data;
}

// These two datagrams end every process that receives them through liblcm 1.3.1 or 1.5.2.
TEST_F(Network, FragmentsThatCrashLiblcmAreCounted) {
  for (const std::string process : {"egocal-pairing", "egocal-fast", "egocal-global"}) start(process);
  const std::size_t colon = url.rfind(':');
  const RawSender sender(static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1))));
  const std::string name{"EGOCAL_STATUS\0", 14};
  sender.send(fragment(100'000, 0, 0, name + std::string(500, 'x')));
  sender.send(fragment(100'000, 0xFFFFFF00U, 1, std::string(0x100, 'x')));
  for (const std::string process : {"egocal-pairing", "egocal-fast", "egocal-global"}) {
    EXPECT_TRUE(until([&] { return counter(process, "rejected: malformed datagrams") == 1; })) << process;
    EXPECT_TRUE(running(process)) << process;
  }
}

// liblcm keeps every channel name for ever: 2 million of them took 100 MB.
TEST_F(Network, NewChannelNamesTakeNoMemory) {
  start("egocal-pairing");
  const auto memory_kb = [&] {
    std::ifstream in("/proc/" + std::to_string(processes.at("egocal-pairing").pid()) + "/status");
    for (std::string line; std::getline(in, line);)
      if (line.starts_with("VmRSS:")) return std::stol(line.substr(6));
    return -1L;
  };
  const std::size_t colon = url.rfind(':');
  const RawSender sender(static_cast<std::uint16_t>(std::stoi(url.substr(colon + 1))));
  const long before = memory_kb();
  for (std::uint32_t i = 0; i < 50'000; ++i)
    sender.send(big_endian(0x4c433032, 4) + big_endian(i, 4) + "CHANNEL_" + std::to_string(i) +
                std::string(1, '\0') + "payload");
  statuses.clear();
  EXPECT_TRUE(until([&] { return statuses.contains("egocal-pairing"); }));
  EXPECT_LT(memory_kb(), before + 3'000);
}

// What lcm-logger records and lcm-logplayer plays is what ours send and receive, whole messages and
// fragments.
TEST_F(Network, LcmsOwnLoggerAndPlayerUnderstandOurs) {
  if (std::system("command -v lcm-logger > /dev/null && command -v lcm-logplayer > /dev/null") != 0)
    GTEST_SKIP() << "lcm-logger and lcm-logplayer (Debian: liblcm-bin) are not installed";
  const std::string log = folder / "session.log";
  ChildProcess lcm_logger({"lcm-logger", "--lcm-url=" + url, "--force", log}, folder / "logger.log");
  const std::vector<std::byte> large(200'000, std::byte{0x5a});
  const auto poses = events(drive(40));
  // the logger does not say when it listens
  ASSERT_TRUE(until([&] {
    loop->publish_bytes("PROBE", large);
    return std::filesystem::exists(log) && std::filesystem::file_size(log) > 0;
  }));
  // the logger's receive buffer is the kernel's default, which holds two of the large messages
  const auto run_for = [&](std::chrono::milliseconds time) { until([] { return false; }, time); };
  // it writes what it has heard several times a second: a file that grows no more holds all
  std::uintmax_t size = 0;
  const auto settled = [&] {
    run_for(500ms);
    const std::uintmax_t before = std::exchange(size, std::filesystem::file_size(log));
    return size == before;
  };
  ASSERT_TRUE(until(settled));
  loop->publish_bytes("LARGE", large);
  ASSERT_TRUE(until([&] { return std::filesystem::file_size(log) >= size + large.size(); }));
  for (const Event& event : poses) {
    loop->publish(channel(event.side), bus::to_message(event.pose, event.seq));
    run_for(5ms);
  }
  ASSERT_TRUE(until(settled));
  lcm_logger.signal(SIGINT);
  EXPECT_EQ(lcm_logger.wait(patience), 0);

  start("egocal-pairing");
  std::size_t received = 0;
  loop->subscribe_bytes("LARGE", [&](const bus::Arrival& arrival) { received = arrival.bytes.size(); });
  ChildProcess lcm_player({"lcm-logplayer", "--lcm-url=" + url, "--speed=4", log}, folder / "player.log");
  EXPECT_TRUE(until([&] { return problem && problem->matched == 39; }));
  EXPECT_EQ(received, large.size());
}

/// "routing or firewall" was blamed for a limit of the user's shell.
TEST_F(Network, IsNotBlamedWhereTooFewFilesMayBeOpen) {
  for (const std::string program : {"egocal-pairing", "egocal-fast", "egocal-global"}) {
    const auto limited = [&](const std::string& most) {
      const std::string log = folder / (program + most + ".log");
      return std::pair{log, ChildProcess({"sh", "-c", "ulimit -n " + most + "; exec \"$0\" \"$@\"",
                                          bin + "/" + program, "--rig", rig_file, "--lcm-url", url},
                                         log)};
    };
    auto [few_log, few] = limited("5");
    EXPECT_EQ(few.wait(patience), 1) << program;
    std::ifstream in(few_log);
    const std::string text{std::istreambuf_iterator<char>(in), {}};
    EXPECT_NE(text.find("Too many open files"), std::string::npos) << text;
    EXPECT_EQ(text.find("route"), std::string::npos) << text;
    EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 1) << text;

    statuses.clear();
    const auto enough = limited("12");
    EXPECT_TRUE(until([&] { return statuses.contains(program); })) << program;
  }
}

}  // namespace
}  // namespace egocal::test_network
