// The watch must catch what it is there to catch: a contract test that cannot fail proves nothing.
#include <gtest/gtest.h>
#include <unistd.h>

#include <atomic>
#include <chrono>
#include <condition_variable>
#include <cstdio>
#include <cstdlib>
#include <iostream>
#include <memory>
#include <mutex>
#include <shared_mutex>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

#include "realtime/watch.hpp"

namespace palpate::realtime {
namespace {

// What `work` does while it is watched.
template <class Work>
Findings watched(const Work& work) {
  Watch watch;
  work();
  return watch.stop();
}

TEST(Detector, FindsNothingInPlainArithmetic) {
  double sum = 0;
  const Findings found = watched([&] {
    for (int i = 1; i < 1000; ++i) sum += 1.0 / i;
  });
  keep(&sum);
  EXPECT_EQ(found.total(), 0) << found;
}

TEST(Detector, CatchesNewAndDelete) {
  const Findings found = watched([] {
    auto* value = new int(3);
    keep(value);
    delete value;
  });
  EXPECT_EQ(found.count(Offence::allocate), 1) << found;
  EXPECT_EQ(found.count(Offence::release), 1) << found;
}

TEST(Detector, CatchesEveryWayToAllocate) {
  const Findings found = watched([] {
    void* block = std::malloc(10);
    block = std::realloc(block, 20);
    keep(block);
    void* zeros = std::calloc(2, 5);
    keep(zeros);
    void* aligned = std::aligned_alloc(64, 128);
    keep(aligned);
    void* posix = nullptr;
    if (posix_memalign(&posix, 64, 128) != 0) posix = nullptr;
    keep(posix);
    struct alignas(128) Wide {
      char bytes[128];
    };
    auto* wide = new Wide;
    keep(wide);
    for (void* each : {block, zeros, aligned, posix}) std::free(each);
    delete wide;
  });
  EXPECT_EQ(found.count(Offence::allocate), 6) << found;
  EXPECT_EQ(found.count(Offence::release), 5) << found;
}

TEST(Detector, CatchesAGrowingVectorAndAString) {
  std::vector<int> values;
  const Findings found = watched([&] {
    values.push_back(1);
    keep(values.data());
    const std::string text(100, 'x');
    keep(text.data());
  });
  EXPECT_EQ(found.count(Offence::allocate), 2) << found;
}

TEST(Detector, CatchesLocks) {
  std::mutex mutex;
  std::shared_mutex shared;
  std::condition_variable condition;
  const Findings found = watched([&] {
    const std::lock_guard lock(mutex);
    const std::shared_lock reading(shared);
    condition.notify_all();
  });
  EXPECT_GE(found.count(Offence::lock), 2) << found;
}

TEST(Detector, CatchesATriedLock) {
  std::mutex mutex;
  const Findings found = watched([&] {
    if (mutex.try_lock()) mutex.unlock();
  });
  EXPECT_EQ(found.count(Offence::lock), 1) << found;
}

TEST(Detector, CatchesOutputThatIsNotFlushedYet) {
  FILE* file = std::tmpfile();
  ASSERT_NE(file, nullptr);
  std::fputs("first use allocates the buffer\n", file);
  const Findings found = watched([&] { std::fprintf(file, "%d\n", 7); });
  std::fclose(file);
  EXPECT_EQ(found.count(Offence::log), 1) << found;
  EXPECT_EQ(found.count(Offence::system_call), 0) << found;
}

TEST(Detector, CatchesOutputToAStream) {
  const Findings found = watched([] { std::cout << "(text of a test)" << std::flush; });
  EXPECT_GE(found.count(Offence::log), 1) << found;
}

TEST(Detector, CatchesAThrowThatIsCaught) {
  const Findings found = watched([] {
    try {
      throw std::runtime_error("no");
    } catch (const std::exception&) {
    }
  });
  EXPECT_EQ(found.count(Offence::raise), 1) << found;
}

TEST(Detector, CatchesAClock) {
  const Findings found = watched([] {
    const auto now = std::chrono::steady_clock::now();
    keep(&now);
  });
  EXPECT_EQ(found.count(Offence::clock), 1) << found;
}

class SystemCalls : public testing::Test {
 protected:
  void SetUp() override {
    if (!can_trap_system_calls()) {
      GTEST_SKIP() << "this kernel has no Syscall User Dispatch (Linux 5.11 on x86-64)";
    }
  }
};

TEST_F(SystemCalls, AreCaughtAndStillMade) {
  const pid_t expected = getpid();
  pid_t process = 0;
  const Findings found = watched([&] { process = getpid(); });
  EXPECT_EQ(found.count(Offence::system_call), 1) << found;
  EXPECT_EQ(process, expected);
}

TEST_F(SystemCalls, AreCaughtWhenTheyYieldSleepOrWait) {
  EXPECT_EQ(watched([] { std::this_thread::yield(); }).count(Offence::system_call), 1);
  EXPECT_EQ(watched([] {
              std::this_thread::sleep_for(std::chrono::microseconds(1));
            }).count(Offence::system_call),
            1);
  std::atomic<int> value{1};
  EXPECT_EQ(watched([&] { value.notify_all(); }).count(Offence::allocate), 0);
}

TEST_F(SystemCalls, OfABigAllocationAreCaught) {
  const Findings found = watched([] {
    const std::vector<char> big(64u << 20);
    keep(big.data());
  });
  EXPECT_EQ(found.count(Offence::system_call), 1) << found;
}

TEST_F(SystemCalls, OutsideAWatchGoUncounted) {
  keep(std::make_unique<int>(getpid()).get());
  const Findings found = watched([] {});
  EXPECT_EQ(found.total(), 0) << found;
}

TEST_F(SystemCalls, OfOtherThreadsGoUncounted) {
  std::atomic<bool> stop{false};
  std::atomic<int> rounds{0};
  std::jthread other([&] {
    while (!stop) {
      keep(std::make_unique<int>(getpid()).get());
      ++rounds;
    }
  });
  while (rounds == 0) std::this_thread::yield();
  const Findings found = watched([&] {
    const int start = rounds;
    while (rounds < start + 10) {
    }
  });
  stop = true;
  EXPECT_EQ(found.total(), 0) << found;
}

}  // namespace
}  // namespace palpate::realtime
