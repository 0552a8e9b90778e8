// Who holds a tool, and what of it others learn.
#include "viewer/room.hpp"

namespace palpate::viewer {
namespace {

using nlohmann::json;

TEST(ClientSessions, WhoMovesAToolHoldsItUntilItLeavesOrLetsGo) {
  Room room;
  Session& one = room.enter();
  Session& other = room.enter();
  const char* hand = R"({"type":"hand","device":0,"position":[1,2,3],"buttons":0})";
  EXPECT_TRUE(room.answers(one, hand).empty());
  EXPECT_EQ(room.hand, Eigen::Vector3d(101, 2, 3));
  EXPECT_TRUE(room.sessions->taken(0));
  room.answers(other, hand);
  room.answers(one, R"({"type":"release","device":0})");  // it is the other's now
  EXPECT_TRUE(room.sessions->taken(0));
  EXPECT_TRUE(room.released.empty());
  room.answers(other, R"({"type":"release","device":0})");
  EXPECT_FALSE(room.sessions->taken(0));
  room.answers(one, hand);
  room.sessions->leave(one);
  EXPECT_FALSE(room.sessions->taken(0));
  EXPECT_EQ(room.released, (std::vector<std::size_t>{0, 0}));
}

TEST(ClientSessions, AToolThatIsNotThereOrNotForPagesIsRefused) {
  Room room;
  Session& session = room.enter();
  room.expect_refused(session, R"({"type":"hand","device":1,"position":[1,2,3],"buttons":0})");
  room.expect_refused(session, R"({"type":"hand","device":2,"position":[1,2,3],"buttons":0})");
  room.expect_refused(session, R"({"type":"release","device":2})");
  EXPECT_EQ(room.hand, Eigen::Vector3d::Zero());
}

TEST(ClientSessions, WhoLosesTheToolToAnotherIsTold) {
  Room room;
  Session& first = room.enter();
  Session& second = room.enter();
  const std::string hand = R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0})";
  EXPECT_TRUE(room.answers(first, hand).empty());
  EXPECT_TRUE(room.answers(second, hand).empty());
  const auto told = Room::said(first);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0],
            (json{{"type", "lost"}, {"device", 0}, {"text", "another page took the tool"}}));
  EXPECT_TRUE(room.answers(second, hand).empty());
  EXPECT_TRUE(Room::said(first).empty());
  room.answers(first, R"({"type":"release","device":0})");
  EXPECT_TRUE(room.sessions->taken(0));
  EXPECT_TRUE(room.released.empty());
}

TEST(ClientSessions, WhatALoserSaidBeforeItKnewTakesNothingBack) {
  Room room;
  Session& first = room.enter();
  Session& second = room.enter();
  const char* far = R"({"type":"hand","device":0,"position":[9,9,9],"buttons":0})";
  const char* near = R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0})";
  room.answers(first, far);
  room.answers(second, near);
  room.answers(first, far);  // it was on its way
  EXPECT_EQ(room.hand, Eigen::Vector3d(100, 0, 0));
  EXPECT_TRUE(Room::said(second).empty());
  room.answers(first, R"({"type":"release","device":0})");
  room.answers(first, far);
  EXPECT_EQ(room.hand, Eigen::Vector3d(109, 9, 9)) << "it takes the tool anew";
  EXPECT_EQ(Room::said(second).size(), 1u);
}

TEST(ClientSessions, AToolWhoseHolderFallsSilentIsLetGo) {
  Room room;
  Session& holder = room.enter();
  const char* hand = R"({"type":"hand","device":0,"position":[0,0,0],"buttons":0})";
  room.answers(holder, hand);
  for (int i = 0; i < 10; ++i) {
    room.sessions->check(room.now += 2);
    room.answers(holder, R"({"type":"ping","id":1})");
  }
  EXPECT_TRUE(room.sessions->taken(0)) << "it says that it is there";
  room.sessions->check(room.now + 4.9);
  EXPECT_TRUE(room.sessions->taken(0));
  room.sessions->check(room.now += 5.1);
  EXPECT_FALSE(room.sessions->taken(0));
  EXPECT_EQ(room.released, std::vector<std::size_t>{0});
  const auto told = Room::said(holder);
  ASSERT_EQ(told.size(), 1u);
  EXPECT_EQ(told[0]["type"], "lost");
  room.sessions->check(room.now += 20);
  EXPECT_EQ(room.released.size(), 1u);
  room.answers(holder, hand);
  EXPECT_FALSE(room.sessions->taken(0)) << "it did not know";
}

}  // namespace
}  // namespace palpate::viewer
