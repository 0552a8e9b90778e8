// Who holds a tool, and what of it others learn.
#include "viewer/sessions_rig.hpp"

namespace palpate::viewer {
namespace {

using nlohmann::json;

TEST(ClientSessions, WhoMovesAToolHoldsItUntilItLeavesOrLetsGo) {
  SessionsRig rig;
  Session& one = rig.enter();
  Session& other = rig.enter();
  const char* hand = R"({"type":"hand","device":0,"position":[1,2,3],"buttons":0})";
  EXPECT_TRUE(rig.answers(one, hand).empty());
  EXPECT_EQ(rig.hand, Eigen::Vector3d(101, 2, 3));
  EXPECT_TRUE(rig.sessions->taken(0));
  rig.answers(other, hand);
  rig.answers(one, R"({"type":"release","device":0})");  // it is the other's now
  EXPECT_TRUE(rig.sessions->taken(0));
  EXPECT_TRUE(rig.released.empty());
  rig.answers(other, R"({"type":"release","device":0})");
  EXPECT_FALSE(rig.sessions->taken(0));
  rig.answers(one, hand);
  rig.sessions->leave(one);
  EXPECT_FALSE(rig.sessions->taken(0));
  EXPECT_EQ(rig.released, (std::vector<std::size_t>{0, 0}));
}

TEST(ClientSessions, AToolThatIsNotThereOrNotForPagesIsRefused) {
  SessionsRig rig;
  Session& session = rig.enter();
  rig.expect_refused(session, R"({"type":"hand","device":1,"position":[1,2,3],"buttons":0})");
  rig.expect_refused(session, R"({"type":"hand","device":2,"position":[1,2,3],"buttons":0})");
  rig.expect_refused(session, R"({"type":"release","device":2})");
  EXPECT_EQ(rig.hand, Eigen::Vector3d::Zero());
}

TEST(ClientSessions, WhoLosesTheToolToAnotherIsTold) {
  SessionsRig rig;
  Session& first = rig.enter();
  Session& second = rig.enter();
  const std::string hand = R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0})";
  EXPECT_TRUE(rig.answers(first, hand).empty());
  EXPECT_TRUE(rig.answers(second, hand).empty());
  const auto told = SessionsRig::said(first);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0],
            (json{{"type", "lost"}, {"device", 0}, {"text", "another page took the tool"}}));
  EXPECT_TRUE(rig.answers(second, hand).empty());
  EXPECT_TRUE(SessionsRig::said(first).empty());
  rig.answers(first, R"({"type":"release","device":0})");
  EXPECT_TRUE(rig.sessions->taken(0));
  EXPECT_TRUE(rig.released.empty());
}

TEST(ClientSessions, TheEyeOfAHandIsInTheWorldToo) {
  SessionsRig rig;
  Session& session = rig.enter();
  rig.answers(session,
              R"({"type":"hand","device":0,"position":[0,0,0],"eye":[1,2,3],"buttons":0})");
  EXPECT_EQ(rig.eye, Eigen::Vector3d(101, 2, 3));
  rig.answers(session, R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0})");
  EXPECT_FALSE(rig.eye);
}

TEST(ClientSessions, WhatALoserSaidBeforeItKnewTakesNothingBack) {
  SessionsRig rig;
  Session& first = rig.enter();
  Session& second = rig.enter();
  const char* far = R"({"type":"hand","device":0,"position":[9,9,9],"buttons":0})";
  const char* near = R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0})";
  rig.answers(first, far);
  rig.answers(second, near);
  rig.answers(first, far);  // it was on its way
  EXPECT_EQ(rig.hand, Eigen::Vector3d(100, 0, 0));
  EXPECT_TRUE(SessionsRig::said(second).empty());
  rig.answers(first, R"({"type":"release","device":0})");
  rig.answers(first, far);
  EXPECT_EQ(rig.hand, Eigen::Vector3d(109, 9, 9)) << "it takes the tool anew";
  EXPECT_EQ(SessionsRig::said(second).size(), 1u);
}

TEST(ClientSessions, AToolWhoseHolderFallsSilentIsLetGo) {
  SessionsRig rig;
  Session& holder = rig.enter();
  const char* hand = R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0})";
  rig.answers(holder, hand);
  for (int i = 0; i < 10; ++i) {
    rig.sessions->check(rig.now += 2);
    rig.answers(holder, R"({"type":"ping","id":1})");
  }
  EXPECT_TRUE(rig.sessions->taken(0)) << "it says that it is there";
  rig.sessions->check(rig.now + 4.9);
  EXPECT_TRUE(rig.sessions->taken(0));
  rig.sessions->check(rig.now += 5.1);
  EXPECT_FALSE(rig.sessions->taken(0));
  EXPECT_EQ(rig.released, std::vector<std::size_t>{0});
  const auto told = SessionsRig::said(holder);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0]["type"], "lost");
  rig.sessions->check(rig.now += 20);
  EXPECT_EQ(rig.released.size(), 1u);
  rig.answers(holder, hand);
  EXPECT_FALSE(rig.sessions->taken(0)) << "it did not know";
}

}  // namespace
}  // namespace palpate::viewer
