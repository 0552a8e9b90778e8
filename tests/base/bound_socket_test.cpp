#include "base/bound_socket.hpp"

#include <gtest/gtest.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <string>

#include "palpate/base/error.hpp"
#include "support/contains.hpp"
#include "support/folder.hpp"

namespace palpate {
namespace {

using Kind = BoundSocket::Kind;

// Does a program that connects find somebody?
bool answered(const std::string& path) {
  const int handle = ::socket(AF_UNIX, SOCK_STREAM, 0);
  sockaddr_un address{};
  address.sun_family = AF_UNIX;
  std::memcpy(address.sun_path, path.c_str(), path.size() + 1);
  const bool found =
      ::connect(handle, reinterpret_cast<const sockaddr*>(&address), sizeof address) == 0;
  ::close(handle);
  return found;
}

// Has a program connected that was not accepted yet?
bool somebody_came(const BoundSocket& socket) {
  const int handle = ::accept(socket.handle(), nullptr, nullptr);
  if (handle >= 0) ::close(handle);
  return handle >= 0;
}

std::string complaint(const std::string& path, Kind kind) {
  try {
    const BoundSocket socket("test", path, kind);
  } catch (const Error& error) {
    return error.what();
  }
  return {};
}

TEST(BoundSocket, ListensWhereItsOwnerAloneMayConnect) {
  const test::Folder folder;
  {
    const mode_t before = ::umask(0);
    const BoundSocket socket("test", folder / "socket", Kind::stream);
    ::umask(before);
    struct stat file {};
    ASSERT_EQ(::stat((folder / "socket").c_str(), &file), 0);
    EXPECT_EQ(file.st_mode & 0777, 0600u);
    EXPECT_FALSE(somebody_came(socket));
    EXPECT_TRUE(answered(folder / "socket"));
    EXPECT_TRUE(somebody_came(socket));
  }
  EXPECT_FALSE(std::filesystem::exists(folder / "socket"));
}

TEST(BoundSocket, TakesNoPathFromAnotherAndIsNotSeenLooking) {
  const test::Folder folder;
  for (const Kind there : {Kind::stream, Kind::datagrams}) {
    const BoundSocket socket("test", folder / "socket", there);
    for (const Kind wanted : {Kind::stream, Kind::datagrams}) {
      const std::string words = complaint(folder / "socket", wanted);
      EXPECT_TRUE(test::contains(words, "test: cannot listen on")) << words;
      EXPECT_TRUE(test::contains(words, "another program is listening there")) << words;
    }
    EXPECT_TRUE(there == Kind::datagrams || !somebody_came(socket));
    EXPECT_TRUE(std::filesystem::exists(folder / "socket"));
  }
}

TEST(BoundSocket, TakesThePlaceOfASocketThatNobodyListensTo) {
  const test::Folder folder;
  for (const Kind left : {Kind::stream, Kind::datagrams}) {
    {
      const BoundSocket crashed("test", folder / "socket", left);
      std::filesystem::rename(folder / "socket", folder / "kept");
    }
    std::filesystem::rename(folder / "kept", folder / "socket");
    ASSERT_FALSE(answered(folder / "socket"));
    const BoundSocket socket("test", folder / "socket", Kind::stream);
    EXPECT_TRUE(answered(folder / "socket"));
  }
}

}  // namespace
}  // namespace palpate
