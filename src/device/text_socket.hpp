#pragma once

#include <cstdint>
#include <memory>
#include <string>

namespace palpate::device {

/// The client end of a WebSocket that carries text messages. Every wait has a limit. One thread.
class TextSocket {
 public:
  /// Connects to "ws://HOST:PORT[/PATH]", `patience` s long at most.
  /// @throws Error that states why nobody answers.
  TextSocket(const std::string& url, double patience);
  ~TextSocket();
  TextSocket(const TextSocket&) = delete;
  TextSocket& operator=(const TextSocket&) = delete;

  /// @throws Error when the other side is gone or does not take it in `patience` s.
  void send(std::string text, double patience);

  /// Takes what has come. @throws Error when the other side is gone.
  void poll();
  /// Waits for more than `count` texts, `patience` s long at most; false: they did not come.
  /// @throws Error when the other side is gone.
  [[nodiscard]] bool wait(std::uint64_t count, double patience);

  /// Texts received so far, and the newest of them.
  [[nodiscard]] std::uint64_t received() const;
  [[nodiscard]] const std::string& newest() const;

 private:
  struct Inside;
  std::unique_ptr<Inside> inside_;
};

}  // namespace palpate::device
