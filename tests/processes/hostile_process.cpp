// SPDX-License-Identifier: Apache-2.0
// A method that is a process and answers the first ten scans well, or as many as its second argument says; then it does
// what its first argument says.
#include <sys/socket.h>
#include <unistd.h>

#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <limits>
#include <string>
#include <vector>

#include "slam/process/client/plumbline_messages.h"

namespace {

namespace wire = plumbline::slam::wire;
constexpr int stream = 3;

bool read_all(void* bytes, std::size_t size) {
  auto* at = static_cast<char*>(bytes);
  while (size > 0) {
    const ssize_t got = ::recv(stream, at, size, 0);
    if (got <= 0) return false;
    at += got;
    size -= static_cast<std::size_t>(got);
  }
  return true;
}

void write_all(const void* bytes, std::size_t size) { (void)!::send(stream, bytes, size, MSG_NOSIGNAL); }

void send(wire::Type type, const void* bytes, std::size_t size, std::uint64_t announced) {
  const wire::Head head{wire::magic, static_cast<std::uint16_t>(type), 0, announced};
  write_all(&head, sizeof head);
  write_all(bytes, size);
}
void send(wire::Type type, const void* bytes, std::size_t size) { send(type, bytes, size, size); }

[[noreturn]] void hang() {
  for (;;) ::pause();
}

/// Until nobody reads it any more.
void send_without_end(const std::vector<char>& bytes) {
  while (::send(stream, bytes.data(), bytes.size(), MSG_NOSIGNAL) > 0) continue;
}

wire::Output good(std::int64_t stamp_ns) {
  wire::Output output;
  output.stamp_ns = stamp_ns;
  output.has_pose = 1;
  output.X_FR.q[3] = 1.0;
  return output;
}

/// What is sent in place of a good answer, or true where the good one shall be sent as well.
bool misbehave(const std::string& how, wire::Output& output) {
  if (how == "exit") std::exit(3);
  if (how == "signal") std::raise(SIGSEGV);
  if (how == "hang") hang();
  if (how == "ignores_signals") {
    for (int signal = 1; signal < 32; ++signal) std::signal(signal, SIG_IGN);
    hang();
  }
  if (how == "grandchild") {
    if (::fork() == 0) hang();
    std::exit(0);
  }
  if (how == "session") {
    if (::fork() == 0) {
      ::setsid();
      if (::fork() != 0) std::_Exit(0);
      if (std::FILE* file = std::fopen(std::getenv("HOSTILE_PID_FILE"), "w")) {
        std::fprintf(file, "%d\n", ::getpid());
        std::fclose(file);
      }
      hang();
    }
    ::sleep(1);
    std::exit(0);
  }
  if (how == "closes") {
    ::close(stream);
    hang();
  }
  if (how == "garbage") {
    const std::string text(100, 'x');
    write_all(text.data(), text.size());
    hang();
  }
  if (how == "huge") send(wire::Type::output, &output, 0, std::numeric_limits<std::uint64_t>::max() / 2);
  if (how == "announces") send(wire::Type::output, &output, sizeof output, wire::max_payload);
  if (how == "short") send(wire::Type::output, &output, sizeof output - 8);
  if (how == "long") {
    std::vector<char> more(sizeof output + 8);
    std::memcpy(more.data(), &output, sizeof output);
    send(wire::Type::output, more.data(), more.size());
  }
  if (how == "type") send(wire::Type::estimate, &output, sizeof output);
  if (how == "drip")
    for (int i = 0; i < 1000; ++i) {
      const std::uint32_t byte = wire::magic & 0xFFU;
      write_all(&byte, i == 0 ? 1 : 0);
      ::usleep(50'000);
    }
  if (how == "fails") {
    const std::string why = "no wall in sight";
    send(wire::Type::fail, why.data(), why.size());
  }
  if (how == "fails_at_length") {
    const std::string why(5'000'000, 'x');
    send(wire::Type::fail, why.data(), why.size());
  }
  if (how == "stamp") ++output.stamp_ns;
  if (how == "nan") output.X_FR.t[0] = std::numeric_limits<double>::quiet_NaN();
  if (how == "quaternion") output.X_FR.q[3] = 0.9;
  if (how == "far") output.X_FR.t[1] = 1e300;
  if (how == "state") output.state = 9;
  if (how == "hypotheses") output.hypotheses = 1;
  if (how == "otherwise") output.X_FR.t[0] = static_cast<double>(::getpid());
  if (how == "particle_otherwise") {
    output.particles = 1;
    struct {
      wire::Output output;
      wire::Particle particle;
    } const both{output, {0.0F, 0.0F, 0.0F, static_cast<float>(::getpid())}};
    static_assert(sizeof both == sizeof(wire::Output) + sizeof(wire::Particle));
    send(wire::Type::output, &both, sizeof both);
  }
  if (how == "twice") send(wire::Type::output, &output, sizeof output);
  if (how == "floods")
    for (int i = 0; i < 20000; ++i) std::printf("%s\n", std::string(1000, '.').c_str());
  if (how == "logs") send(wire::Type::log, "a line", 6);
  if (how == "logs_on") {
    const wire::Head head{wire::magic, static_cast<std::uint16_t>(wire::Type::log), 0, 0};
    std::vector<char> lines(1000 * sizeof head);
    for (std::size_t at = 0; at < lines.size(); at += sizeof head) std::memcpy(&lines[at], &head, sizeof head);
    send_without_end(lines);
  }
  return how == "stamp" || how == "nan" || how == "quaternion" || how == "far" || how == "state" ||
         how == "hypotheses" || how == "otherwise" || how == "twice" || how == "floods" || how == "logs" ||
         how.starts_with("finish_");
}

}  // namespace

int main(int argc, char** argv) {
  const std::string how = argc > 1 ? argv[1] : "good";
  const int good_scans = argc > 2 ? std::atoi(argv[2]) : 10;
  if (how == "dies_at_once") {
    std::fprintf(stderr, "libcuda is missing\n");
    return 7;
  }
  wire::Head head;
  std::vector<char> payload;
  for (int scans = 0; read_all(&head, sizeof head);) {
    payload.resize(head.size);
    if (!read_all(payload.data(), payload.size())) return 0;
    switch (static_cast<wire::Type>(head.type)) {
      case wire::Type::hello: {
        const std::string answer = how == "old"       ? R"({"protocol": 0})"
                                   : how == "no_json" ? "hello"
                                                      : "{\"protocol\": " + std::to_string(wire::protocol) + "}";
        if (how == "never_greets") hang();
        send(wire::Type::hello_ok, answer.data(), answer.size());
        if (how == "never_reads") hang();
        break;
      }
      case wire::Type::step: {
        std::int64_t stamp_ns = 0;
        std::memcpy(&stamp_ns, payload.data(), sizeof stamp_ns);
        wire::Output output = good(stamp_ns);
        ++scans;
        if (scans <= good_scans || how == "good" || how == "no_poses" || misbehave(how, output))
          send(wire::Type::output, &output, sizeof output);
        break;
      }
      case wire::Type::finish: {
        struct {
          wire::Estimate estimate;
          float point[3];
        } const answer{{0, how == "no_poses" ? 1000ULL : 0ULL, how == "finish_otherwise" ? 1ULL : 0ULL},
                       {static_cast<float>(::getpid() % 10'000), 0.0F, 0.0F}};
        send(wire::Type::estimate, &answer,
             how == "finish_otherwise" ? sizeof(wire::Estimate) + sizeof answer.point : sizeof(wire::Estimate));
        if (how == "finish_stays") hang();
        if (how == "finish_floods") send_without_end(std::vector<char>(1 << 16));
        if (how == "finish_exits") return 7;
        if (how == "finish_signal") std::raise(SIGSEGV);
        break;
      }
      default:
        return 1;
    }
  }
  return 0;
}
