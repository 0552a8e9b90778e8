#include "viewer/access.hpp"

#include <gtest/gtest.h>

namespace palpate::viewer {
namespace {

const Listening kLocal{"127.0.0.1", 8420, false};
const Listening kLocal6{"::1", 8420, false};
const Listening kEverywhere{"0.0.0.0", 8420, true};

TEST(RequestCheck, HostNamesTheAddressAndThePort) {
  for (const char* host : {"127.0.0.1:8420", "localhost:8420", "LOCALHOST:8420"}) {
    EXPECT_TRUE(host_is_ours(host, kLocal)) << host;
  }
  for (const char* host :
       {"", "127.0.0.1", "127.0.0.1:8421", "127.0.0.1:", "127.0.0.1:08420", "127.0.0.2:8420",
        "evil.example:8420", "localhost.evil.example:8420", "127.0.0.1:8420.evil.example",
        "evil@127.0.0.1:8420", "[127.0.0.1]:8420", "[::1", "[::1]8420", ":8420", "127.0.0.1:8420 ",
        "127.0.0.1:84200", "localhost"}) {
    EXPECT_FALSE(host_is_ours(host, kLocal)) << host;
  }
  EXPECT_FALSE(host_is_ours(std::string(1000, 'a') + ":8420", kLocal));
  EXPECT_TRUE(host_is_ours("[::1]:8420", kLocal6));
  EXPECT_TRUE(host_is_ours("localhost:8420", kLocal6));
  EXPECT_FALSE(host_is_ours("::1:8420", kLocal6));
  EXPECT_TRUE(host_is_ours("127.0.0.1", {"127.0.0.1", 80, false}));
}

TEST(RequestCheck, WhoListensEverywhereIsNamedByNumbersAlone) {
  for (const char* host :
       {"192.168.1.7:8420", "127.0.0.1:8420", "localhost:8420", "[fe80::1]:8420"}) {
    EXPECT_TRUE(host_is_ours(host, kEverywhere)) << host;
  }
  for (const char* host : {"evil.example:8420", "192.168.1.7:80", "1.2.3:8420", "1.2.3.4.5:8420",
                           "[evil]:8420", "300.1.1.1:8420"}) {
    EXPECT_FALSE(host_is_ours(host, kEverywhere)) << host;
  }
}

TEST(RequestCheck, OriginIsTheHostsOwn) {
  EXPECT_TRUE(origin_is_ours("http://127.0.0.1:8420", "127.0.0.1:8420"));
  EXPECT_TRUE(origin_is_ours("http://LocalHost:8420", "localhost:8420"));
  for (const char* origin :
       {"", "null", "http://", "https://127.0.0.1:8420", "http://127.0.0.1", "http://evil.example",
        "http://localhost:8420", "http://127.0.0.1:8420/", "http://127.0.0.1:8420.evil.example"}) {
    EXPECT_FALSE(origin_is_ours(origin, "127.0.0.1:8420")) << origin;
  }
}

TEST(RequestCheck, AnAddressIsWrittenAsAUrlHasIt) {
  EXPECT_EQ(authority(kLocal), "127.0.0.1:8420");
  EXPECT_EQ(authority(kLocal6), "[::1]:8420");
}

TEST(Token, Has128BitsThatDifferEachTime) {
  const std::string token = make_token();
  EXPECT_EQ(token.size(), 32u);
  EXPECT_EQ(token.find_first_not_of("0123456789abcdef"), std::string::npos);
  EXPECT_NE(token, make_token());
}

TEST(Token, OnlyItselfIsTheSame) {
  EXPECT_TRUE(same_token("abcd", "abcd"));
  for (const char* given : {"", "a", "abc", "abce", "abcde", "abcdabcd", "ABCD"}) {
    EXPECT_FALSE(same_token(given, "abcd")) << given;
  }
  EXPECT_FALSE(same_token("", ""));
  EXPECT_FALSE(same_token("a", ""));
}

}  // namespace
}  // namespace palpate::viewer
