// Where a viewer listens, and what of it others get to see.
#include <fcntl.h>
#include <gtest/gtest.h>

#include <optional>
#include <set>

#include "palpate/base/error.hpp"
#include "viewer/viewer_rig.hpp"

namespace palpate {
namespace {

using test::RawClient;
using test::ViewerRig;

/// Files of this process that a program which it starts would have, too.
std::set<int> inherited() {
  std::set<int> found;
  for (int file = 0; file < 1024; ++file) {
    const int flags = ::fcntl(file, F_GETFD);
    if (flags >= 0 && (flags & FD_CLOEXEC) == 0) found.insert(file);
  }
  return found;
}

TEST(Serving, NoProgramThatIsStartedInheritsItsSockets) {
  const std::set<int> before = inherited();
  ViewerRig rig;
  const auto client = rig.enter();
  RawClient idle(rig.viewer->port());
  rig.wait([](const Viewer::Counts& counts) { return counts.connections == 2; });
  EXPECT_EQ(inherited(), before);
}

ViewerOptions anywhere(const std::string& address) {
  ViewerOptions options;
  options.port = 0;
  options.address = address;
  options.token = "secret";
  return options;
}

TEST(Serving, OnAllAddressesItsUrlNamesThisMachine) {
  Scene scene;
  const Viewer viewer(scene, {}, anywhere("0.0.0.0"));
  EXPECT_EQ(viewer.url(), "http://" + test::local(viewer.port()) + "/#secret");
}

TEST(Serving, WhoComesBetweenTwoViewersWaitsForTheNext) {
  Scene scene;
  std::optional<Viewer> viewer;
  viewer.emplace(scene, std::vector<Servo*>{}, anywhere("127.0.0.1"));
  const std::uint16_t port = viewer->port();
  ViewerOptions options = anywhere("127.0.0.1");
  options.listening = viewer->listening();
  viewer.reset();
  RawClient early(port);
  early.send("GET / HTTP/1.1\r\nHost: " + test::local(port) + "\r\n\r\n");
  viewer.emplace(scene, std::vector<Servo*>{}, options);
  EXPECT_EQ(viewer->port(), port);
  EXPECT_TRUE(early.read_header().starts_with("HTTP/1.1 200"));
  viewer.reset();
  options.listening.reset();
  EXPECT_THROW(RawClient{port}, std::runtime_error) << "nobody keeps it any more";
}

TEST(Serving, AnswersOnAnAddressOfVersion6) {
  Scene scene;
  std::optional<Viewer> viewer;
  try {
    viewer.emplace(scene, std::vector<Servo*>{}, anywhere("::1"));
  } catch (const Error& error) {
    GTEST_SKIP() << error.what();
  }
  const std::string host = "[::1]:" + std::to_string(viewer->port());
  EXPECT_EQ(viewer->url(), "http://" + host + "/#secret");
  RawClient client(viewer->port(), RawClient::Loopback::v6);
  EXPECT_TRUE(client.upgrade(host, "http://" + host).starts_with("HTTP/1.1 101"));
  client.send_text(R"({"type":"hello","token":"secret","points":10})");
  EXPECT_EQ(client.receive_json("welcome")["version"], 2);
}

TEST(Serving, RefusesTokensThatCannotBeSaid) {
  Scene scene;
  ViewerOptions options = anywhere("127.0.0.1");
  for (const std::string& token : {std::string(257, 'a'), std::string("a#b"), std::string("a&b"),
                                   std::string("a=b"), std::string("%41")}) {
    options.token = token;
    EXPECT_THROW(Viewer(scene, {}, options), Error) << token;
  }
  options.token = std::string(256, 'a');
  EXPECT_NO_THROW(Viewer(scene, {}, options));
}

TEST(Serving, PagesAreToldThatItEnds) {
  std::optional<ViewerRig> rig(std::in_place);
  const auto client = rig->enter();
  const auto stranger = rig->connect();
  stranger->send_text("nonsense");
  stranger->receive_json("refused");  // so that its socket is there
  rig.reset();
  EXPECT_EQ(client->receive_close(), 1001);
  EXPECT_EQ(stranger->receive_close(), 1001);
}

}  // namespace
}  // namespace palpate
