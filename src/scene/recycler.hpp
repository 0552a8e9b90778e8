#pragma once

#include <cstddef>
#include <memory>
#include <mutex>
#include <new>
#include <utility>
#include <vector>

namespace palpate {

/// Objects keep everything while nobody uses them.
struct KeepAll {
  template <class T>
  void operator()(T& /*object*/) const noexcept {}
};

/// Gives out objects that come back by themselves when their last owner lets go of them, with the
/// memory that they have gathered, and gives them out again. Once as many exist as are in use at a
/// time, nothing is allocated any more, counts of owners included. Owners may let go on any thread,
/// and may outlive the recycler. `Rest` releases what an object must not keep while nobody uses it.
template <class T, class Rest = KeepAll>
class Recycler {
 public:
  /// An object as its last owner left it, or a new one.
  [[nodiscard]] std::shared_ptr<T> take() {
    std::unique_ptr<T> object = store_->pop();
    return std::shared_ptr<T>(object.release(), GiveBack{store_}, Blocks<T>{store_});
  }

 private:
  /// Holds the objects that are not in use. Owners keep it alive.
  class Store {
   public:
    Store() = default;
    Store(const Store&) = delete;
    Store& operator=(const Store&) = delete;
    ~Store() {
      for (void* block : blocks_) ::operator delete(block);
    }

    [[nodiscard]] std::unique_ptr<T> pop() {
      const std::lock_guard lock(mutex_);
      if (!idle_.empty()) {
        std::unique_ptr<T> object = std::move(idle_.back());
        idle_.pop_back();
        return object;
      }
      ++objects_;
      idle_.reserve(objects_);  // so that push() never allocates
      blocks_.reserve(objects_);
      return std::make_unique<T>();
    }

    void push(T* object) noexcept {
      const std::lock_guard lock(mutex_);
      idle_.emplace_back(object);
    }

    [[nodiscard]] void* pop_block(std::size_t bytes) {
      const std::lock_guard lock(mutex_);
      if (blocks_.empty()) return ::operator new(bytes);
      void* block = blocks_.back();
      blocks_.pop_back();
      return block;
    }

    void push_block(void* block) noexcept {
      const std::lock_guard lock(mutex_);
      blocks_.push_back(block);
    }

   private:
    std::mutex mutex_;
    std::vector<std::unique_ptr<T>> idle_;
    std::vector<void*> blocks_;  // all of one size: that of a shared_ptr's counts
    std::size_t objects_ = 0;
  };

  struct GiveBack {
    std::shared_ptr<Store> store;
    void operator()(T* object) const noexcept {
      Rest()(*object);
      store->push(object);
    }
  };

  /// Allocates the counts of shared_ptr, which are of one type.
  template <class U>
  struct Blocks {
    using value_type = U;

    explicit Blocks(std::shared_ptr<Store> from) : store(std::move(from)) {}
    template <class V>
    Blocks(const Blocks<V>& other) : store(other.store) {}  // NOLINT(google-explicit-constructor)

    [[nodiscard]] U* allocate(std::size_t n) {
      return static_cast<U*>(store->pop_block(n * sizeof(U)));
    }
    void deallocate(U* block, std::size_t /*n*/) noexcept { store->push_block(block); }
    template <class V>
    [[nodiscard]] bool operator==(const Blocks<V>& other) const {
      return store == other.store;
    }

    std::shared_ptr<Store> store;
  };

  std::shared_ptr<Store> store_ = std::make_shared<Store>();
};

}  // namespace palpate
