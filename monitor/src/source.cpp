// SPDX-FileCopyrightText: 2026 the egocal developers
// SPDX-License-Identifier: BSD-3-Clause
#include "source.hpp"

#include <poll.h>

#include <filesystem>
#include <utility>

#include "egocal/bus/loop.hpp"

namespace egocal::monitor {

Source::Source(Model& model, const ProgramOptions& options, const std::string& url,
               const std::vector<bus::Sensor>& sensors) {
  if (options.log.empty()) {
    feed_ = std::make_unique<Feed>(
        model, FeedOptions{url, options.version, model.options().heartbeat_timeout, sensors});
    name_ = url.substr(0, url.find('?'));
  } else {
    recording_ = std::make_unique<Recording>(model, options.log, options.speed);
    name_ = "log " + std::filesystem::path(options.log).filename().string();
  }
}

std::string Source::nothing_in_words() const {
  if (live()) return "nothing received on " + name_;
  return name_ + " holds nothing of egocal's processes, odometry at most: `egocal up RIG --log` plays it";
}

void Source::watch(std::vector<int> fds) {
  if (feed_) feed_->watch(fds);
  fds_ = std::move(fds);
}

void Source::wait(int milliseconds) {
  if (feed_) {
    feed_->wait(milliseconds);
    return;
  }
  std::vector<pollfd> fds;
  for (const int fd : fds_) fds.push_back({fd, POLLIN, 0});
  poll(fds.data(), fds.size(), milliseconds);
}

Now Source::advance() {
  return recording_ ? recording_->advance(bus::mono_us()) : feed_->now();
}

std::string Source::send(const command_t& command) {
  return !feed_ || feed_->send(command) ? std::string{} : feed_->error();
}

}  // namespace egocal::monitor
