// Lets clients misbehave and tells the consequences: answers, times, descriptors, memory.

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <filesystem>
#include <fstream>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "palpate/base/clock.hpp"
#include "palpate/viewer/viewer.hpp"
#include "viewer/raw_client.hpp"
#include "viewer/viewer_run.hpp"

namespace {

using namespace palpate;
using test::RawClient;

constexpr const char* kToken = "bench";
constexpr int kConnections = 10'000;  // judgement: more than descriptors would last
constexpr int kSlow = 60;             // derived: nearly all of the 64 that there may be

double now() {
  return SteadyClock().now();
}

std::size_t descriptors() {
  const std::filesystem::directory_iterator open("/proc/self/fd");
  return static_cast<std::size_t>(std::distance(begin(open), end(open)));
}

double megabytes() {
  std::ifstream file("/proc/self/statm");
  long pages = 0;
  file >> pages >> pages;
  return 1e-6 * static_cast<double>(pages * sysconf(_SC_PAGESIZE));
}

class Attacks {
 public:
  Attacks() {
    viewer_bench::add_cloud(scene_, 3000);
    ViewerOptions options;
    options.port = 0;
    options.token = kToken;
    viewer_ = std::make_unique<Viewer>(scene_, std::vector<Servo*>{}, options);
    good_ = enter();
  }

  void run() {
    fmt::print("| who | what came of it | after | another page's ping then |\n|---|---|---|---|\n");
    row("a page of another origin", [&] {
      RawClient client(viewer_->port());
      return first_line(client.upgrade(host(), "http://example.org"));
    });
    row("another host's name", [&] {
      RawClient client(viewer_->port());
      return first_line(client.upgrade("example.org"));
    });
    row("a wrong token", [&] {
      auto client = connect();
      client->send_text(R"({"type":"hello","token":"guess","points":10})");
      return closed_with(*client);
    });
    row("a message of 1 GB", [&] {
      auto client = enter();
      client->send(std::string("\x81\xff\0\0\0\0\x40\0\0\0\1\2\3\4", 14));
      return closed_with(*client);
    });
    row("JSON that is none, 20 times",
        [&] { return nonsense([](RawClient& client) { client.send_text("{\"type\":"); }); });
    row("binary messages, 20 times", [&] {
      return nonsense([](RawClient& client) { client.send_frame(2, std::string("\0\1\2", 3)); });
    });
    row(fmt::format("{} requests that come letter by letter", kSlow), [&] { return slow_ones(); });
    row(fmt::format("{} connections, one after another", kConnections),
        [&] { return many_connections(); });
  }

 private:
  void row(const std::string& who, const std::function<std::string()>& attack) {
    const double begin = now();
    const std::string answer = attack();
    const double after = now() - begin;
    fmt::print("| {} | {} | {} | {:.1f} ms |\n", who, answer, in_words(after), 1e3 * ping());
  }

  static std::string in_words(double seconds) {
    return seconds < 1 ? fmt::format("{:.1f} ms", 1e3 * seconds) : fmt::format("{:.1f} s", seconds);
  }

  [[nodiscard]] std::string host() const { return test::local(viewer_->port()); }

  [[nodiscard]] std::unique_ptr<RawClient> connect() const {
    auto client = std::make_unique<RawClient>(viewer_->port());
    (void)client->upgrade(host());
    return client;
  }
  [[nodiscard]] std::unique_ptr<RawClient> enter() const {
    auto client = connect();
    client->send_text(fmt::format(R"({{"type":"hello","token":"{}","points":500}})", kToken));
    client->receive_json("welcome");
    return client;
  }
  double ping() {
    const double begin = now();
    good_->send_text(R"({"type":"ping","id":1})");
    good_->receive_json("pong");
    return now() - begin;
  }

  static std::string first_line(const std::string& header) {
    return header.substr(0, header.find('\r'));
  }
  static std::string closed_with(RawClient& client) {
    return fmt::format("closed with {}", client.receive_close());
  }

  std::string nonsense(const std::function<void(RawClient&)>& say) {
    auto client = enter();
    const std::uint64_t before = viewer_->counts().refused;
    for (int i = 0; i < 20; ++i) say(*client);
    const std::string end = closed_with(*client);
    wait([&] { return viewer_->counts().refused >= before + 20; });
    return fmt::format("`refused` {} times, then {}", viewer_->counts().refused - before, end);
  }

  std::string slow_ones() {
    std::vector<std::unique_ptr<RawClient>> slow;
    for (int i = 0; i < kSlow; ++i) {
      slow.push_back(std::make_unique<RawClient>(viewer_->port()));
      slow.back()->send("GET / HTTP/1.1\r\nX: ");
    }
    wait([&] { return viewer_->counts().connections == kSlow + 1; });
    double longest = 0;
    while (viewer_->counts().connections > 1) {
      for (auto& client : slow) trickle(*client);
      longest = std::max(longest, ping());
      std::this_thread::sleep_for(std::chrono::milliseconds(50));
    }
    return fmt::format("all closed; the other page's ping took {:.1f} ms at most", 1e3 * longest);
  }

  static void trickle(RawClient& client) {
    try {
      client.send("a");
    } catch (const std::runtime_error&) {
      return;  // it is closed
    }
  }

  std::string many_connections() {
    const std::size_t open = descriptors();
    const double memory = megabytes();
    const std::uint64_t before = viewer_->counts().accepted;
    for (int i = 0; i < kConnections; ++i) leave(i);
    wait([&] {
      const Viewer::Counts counts = viewer_->counts();
      return counts.connections == 1 && counts.accepted == before + kConnections;
    });
    return fmt::format(
        "{} turned away; descriptors {} before and {} after, memory {:.1f} and {:.1f} MB",
        viewer_->counts().turned_away, open, descriptors(), memory, megabytes());
  }

  // Opens a connection of each kind in turn and leaves it in its state.
  void leave(int i) {
    RawClient client(viewer_->port());
    if (i % 4 == 1) {
      client.send("GET / HTTP/1.1\r\nHost: " + host() + "\r\nConnection: close\r\n\r\n");
      (void)client.read_body(client.read_header());
    } else if (i % 4 > 1) {
      (void)client.upgrade(host());
    }
    if (i % 4 != 3) return;
    client.send_text(fmt::format(R"({{"type":"hello","token":"{}","points":10}})", kToken));
    client.receive_json("welcome");
  }

  static void wait(const std::function<bool()>& so) {
    while (!so()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }

  Scene scene_;
  std::unique_ptr<Viewer> viewer_;
  std::unique_ptr<RawClient> good_;
};

}  // namespace

int main() {
  try {
    Attacks().run();
  } catch (const std::exception& error) {
    fmt::print(stderr, "hostile_bench: {}\n", error.what());
    return 2;
  }
  return 0;
}
