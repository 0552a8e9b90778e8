#include "apps/palpate/doctor/system.hpp"

#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include "support/folder.hpp"

namespace palpate::app::doctor {
namespace {

// A port of this machine's own that is taken until the end, open to others once it listens.
class Port {
 public:
  Port() : socket_(::socket(AF_INET, SOCK_STREAM, 0)) {
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof address;
    EXPECT_EQ(bind(socket_, reinterpret_cast<const sockaddr*>(&address), size), 0);
    EXPECT_EQ(getsockname(socket_, reinterpret_cast<sockaddr*>(&address), &size), 0);
    number_ = ntohs(address.sin_port);
  }
  ~Port() { close(socket_); }
  Port(const Port&) = delete;
  Port& operator=(const Port&) = delete;
  void listen() const { EXPECT_EQ(::listen(socket_, 1), 0); }
  [[nodiscard]] int number() const { return number_; }

 private:
  int socket_;
  int number_ = 0;
};

TEST(DoctorSystem, HearsWhoListens) {
  const Port port;
  EXPECT_FALSE(this_system().listens(port.number()));
  port.listen();
  EXPECT_TRUE(this_system().listens(port.number()));
}

TEST(DoctorSystem, KnowsItsLocales) {
  const System system = this_system();
  EXPECT_EQ(system.decimal_point("C"), ".");
  EXPECT_EQ(system.decimal_point("xx_XX.UTF-8"), std::nullopt);
}

TEST(DoctorSystem, SeesWhatThisUserMayOpen) {
  const System system = this_system();
  const test::Folder folder;
  folder.write("node", "");
  const Node node = system.node(folder.path() / "node");
  EXPECT_TRUE(node.there);
  EXPECT_TRUE(node.may_open);
  EXPECT_FALSE(node.group.empty());
  EXPECT_FALSE(system.node(folder.path() / "none").there);
}

TEST(DoctorSystem, RunsCommands) {
  const System system = this_system();
  EXPECT_TRUE(system.succeeds({"sh", "-c", "exit 0"}));
  EXPECT_FALSE(system.succeeds({"sh", "-c", "exit 3"}));
  EXPECT_FALSE(system.succeeds({"a-program-that-is-not-there"}));
}

TEST(DoctorSystem, TriesStepsAndLeavesThisThreadAsItWas) {
  const int policy = sched_getscheduler(0);
  const RealtimeTrial trial = this_system().try_realtime(0.02);
  EXPECT_FALSE(trial.report.requests.empty());
  EXPECT_GE(trial.lateness.count, 1u);
  EXPECT_GE(trial.lateness.count + trial.left_out, 20u);
  EXPECT_EQ(sched_getscheduler(0), policy);
  EXPECT_EQ(this_system().try_realtime(0).lateness.count, 0u);
}

}  // namespace
}  // namespace palpate::app::doctor
