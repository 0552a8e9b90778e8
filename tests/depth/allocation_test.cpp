#include <gtest/gtest.h>

#include <atomic>
#include <cstdlib>
#include <new>

#include "depth/small_frames.hpp"

namespace {

thread_local long allocations = 0;

void* counted(std::size_t size, std::size_t alignment) {
  ++allocations;
  void* memory = std::aligned_alloc(alignment, (size + alignment - 1) / alignment * alignment);
  if (memory == nullptr) throw std::bad_alloc();
  return memory;
}

}  // namespace

void* operator new(std::size_t size) {
  return counted(size, alignof(std::max_align_t));
}
void* operator new(std::size_t size, std::align_val_t alignment) {
  return counted(size, static_cast<std::size_t>(alignment));
}
void operator delete(void* memory) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::align_val_t) noexcept {
  std::free(memory);
}
void operator delete(void* memory, std::size_t, std::align_val_t) noexcept {
  std::free(memory);
}

namespace palpate::test {
namespace {

TEST(DepthFilterMemory, IsTakenOnce) {
  const std::vector<Solid> solids = {sphere({0.03, 0, 0.6}, 0.06), plane({0, 0, 0.9}, {0, 0, -1})};
  std::vector<DepthFrame> frames;
  for (std::uint64_t i = 0; i < 6; ++i) frames.push_back(noisy_frame(solids, {}, i));
  for (const bool given : {true, false}) {
    DepthFilterOptions options;
    if (given) options.noise = kinect_like_noise();
    DepthFilter filter(options);
    // Few enough rows for one thread: several threads take memory for their tasks.
    const std::vector<Ball> balls = {{{0.03, 0, 0.54}, 0.004}};  // at the sphere's front
    const Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
    filter.filter(frames[0], pose);
    filter.filter(frames[1], pose, balls);
    const long before = allocations;
    ASSERT_GT(before, 0);
    for (std::size_t i = 2; i < frames.size(); ++i) filter.filter(frames[i], pose, balls);
    EXPECT_EQ(allocations, before) << (given ? "noise given" : "noise measured");
  }
}

}  // namespace
}  // namespace palpate::test
