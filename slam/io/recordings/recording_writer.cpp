// SPDX-License-Identifier: Apache-2.0
#include "slam/io/recordings/recording_writer.h"

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <optional>

#include "slam/io/packets/pcap.h"
#include "slam/io/recordings/record_file.h"

namespace plumbline::slam {

namespace {

/// A text file that grows.
class TextFile {
 public:
  explicit TextFile(std::string path) : path_(std::move(path)), file_(std::fopen(path_.c_str(), "wb")) {
    if (file_ == nullptr) fail();
  }
  ~TextFile() {
    if (file_ != nullptr) std::fclose(file_);
  }
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  void add(std::string_view text) {
    if (std::fwrite(text.data(), 1, text.size(), file_) != text.size()) fail();
  }
  void finish() {
    if (std::fflush(file_) != 0 || ::fsync(::fileno(file_)) != 0) fail();
    std::FILE* file = file_;
    file_ = nullptr;
    if (std::fclose(file) != 0) fail();
  }

 private:
  [[noreturn]] void fail() const { throw EnvironmentError(path_ + ": cannot be written: " + std::strerror(errno)); }

  std::string path_;
  std::FILE* file_;
};

std::string path_in(const std::string& dir, std::string_view name) { return dir + "/" + std::string(name); }

}  // namespace

struct RecordingWriter::Impl {
  Impl(const std::string& dir_in, const RecordingInfo& info_in)
      : dir(dir_in),
        info(info_in),
        pcap(path_in(dir, recording_files::lidar)),
        odometry(path_in(dir, recording_files::odometry)),
        imu(path_in(dir, recording_files::imu)) {
    imu.add(std::string(imu_header) + "\n");
  }

  /// Only where covariances are known.
  TextFile& covariances() {
    if (!covariance) {
      covariance.emplace(path_in(dir, recording_files::covariance));
      covariance->add(std::string(covariance_header) + "\n");
    }
    return *covariance;
  }

  std::string dir;
  RecordingInfo info;
  PcapWriter pcap;
  TextFile odometry;
  std::optional<TextFile> covariance;
  TextFile imu;
};

RecordingWriter::RecordingWriter(const std::string& dir, const RecordingInfo& info)
    : impl_(std::make_unique<Impl>(dir, info)) {}

RecordingWriter::~RecordingWriter() = default;

void RecordingWriter::add(std::span<const Vlp16Packet> packets, std::span<const Odometry> odometry,
                          std::span<const Imu> imu) {
  if (!impl_->info.lidar.packets_per_message && !packets.empty())
    impl_->info.lidar.packets_per_message = static_cast<int>(packets.size());
  for (const Vlp16Packet& packet : packets) impl_->pcap.add(packet);
  for (const Odometry& record : odometry) impl_->odometry.add(odometry_line(record));
  for (const Imu& record : imu) impl_->imu.add(imu_line(record));
}

void RecordingWriter::add(std::span<const OdometryCovariance> covariances) {
  for (const OdometryCovariance& record : covariances) impl_->covariances().add(covariance_line(record));
}

void RecordingWriter::finish(const std::optional<std::string>& walk) {
  impl_->pcap.finish();
  impl_->odometry.finish();
  if (impl_->covariance) impl_->covariance->finish();
  impl_->imu.finish();
  impl_->info.walk = walk;
  TextFile info(path_in(impl_->dir, recording_files::info));
  info.add(write_recording_info(impl_->info));
  info.finish();
}

}  // namespace plumbline::slam
