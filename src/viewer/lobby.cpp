#include "viewer/lobby.hpp"

#include <fmt/core.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>
#include <variant>

#include "palpate/base/error.hpp"
#include "viewer/setting_check.hpp"
#include "viewer/token.hpp"

namespace palpate::viewer {
namespace {

Message text_message(std::string text) {
  return {std::make_shared<const std::string>(std::move(text)), true};
}

template <class Function>
void require(const Function& function, const char* what) {
  if (!function) throw Error(fmt::format("this program does not let a page {}", what));
}

}  // namespace

void Lobby::leave(Client& client) {
  std::erase(clients_, &client);
  for (std::size_t device = 0; device < holders_.size(); ++device) {
    if (holders_[device] != &client) continue;
    try {
      release(device);
    } catch (const std::exception&) {
      continue;  // whoever would have to know is gone
    }
  }
}

void Lobby::take(Client& client, std::string_view text, double now) {
  if (client.closing) return;
  client.heard = now;
  if (client.messages.exceeded(now)) {
    refuse(client, fmt::format("more than {} messages a second", options_.limits.messages), now);
    return;
  }
  try {
    const ClientMessage message = read_message(text);
    const bool hello = std::holds_alternative<Hello>(message);
    if (!client.greeted && !hello) throw Error("say hello first");
    if (client.greeted && hello) throw Error("hello was said already");
    dispatch(client, message);
  } catch (const std::exception& error) {
    refuse(client, error.what(), now);
  }
}

void Lobby::take_binary(Client& client, double now) {
  if (!client.closing) refuse(client, "a binary message; say it in JSON", now);
}

void Lobby::check(double now) {
  for (Client* client : clients_) {
    const bool late = !client->greeted && now - client->opened > options_.limits.hello_time;
    if (late && !client->closing)
      close(*client, close_code::kTryAgainLater, "no hello came in time");
  }
  for (std::size_t device = 0; device < holders_.size(); ++device) {
    const Client* holder = holders_[device];
    if (holder == nullptr || now - holder->heard <= options_.limits.hand_silence) continue;
    lose(device, fmt::format("nothing was heard of this page for {} s: the tool is let go",
                             options_.limits.hand_silence));
    release(device);
  }
}

void Lobby::dispatch(Client& client, const ClientMessage& message) {
  std::visit([&](const auto& read) { act(client, read); }, message);
}

void Lobby::act(Client& client, const Hello& hello) {
  if (!same_token(hello.token, options_.token)) {
    ++wrong_tokens_;
    close(client, close_code::kPolicy, "the token is another; take the address that was printed");
    return;
  }
  if (greeted().size() >= options_.limits.clients) {
    ++turned_away_;
    const std::string words =
        fmt::format("{} pages look already; close one of them", options_.limits.clients);
    answer(client, refused_text(words));
    close(client, close_code::kTryAgainLater, words);
    return;
  }
  welcome(client);
  client.greeted = true;
  client.points = hello.points;
}

void Lobby::welcome(Client& client) {
  Welcome welcome = options_.welcome();
  welcome.devices = options_.devices;
  welcome.settings = settings();
  welcome.presets = options_.controls.presets;
  answer(client, welcome_text(welcome));
  for (const Notice& notice : welcome.notices) answer(client, notice_text(notice));
  if (!recording_.empty()) {
    client.outbox.put({Topic::Kind::record}, text_message(record_text(true, recording_)));
  }
}

void Lobby::act(Client& client, const Hand& hand) {
  const ViewerControls& controls = options_.controls;
  require(controls.hand, "move the tool");
  if (hand.device >= holders_.size() || !options_.devices[hand.device].takeable) {
    throw Error(fmt::format("there is no tool {} that a page may move", hand.device));
  }
  if (client.lost.contains(hand.device)) return;  // said before it knew
  controls.hand(hand.device, options_.origin + hand.position, hand.buttons);
  Client* const before = holders_[hand.device];
  if (before != nullptr && before != &client) lose(hand.device, "another page took the tool");
  holders_[hand.device] = &client;
}

// Of another's tool: it was taken away in the meantime, and this client knows it now.
void Lobby::act(Client& client, const Release& wish) {
  if (wish.device >= holders_.size()) throw Error("there is no such tool");
  client.lost.erase(wish.device);
  if (holders_[wish.device] == &client) release(wish.device);
}

void Lobby::lose(std::size_t device, std::string_view why) {
  Client& holder = *std::exchange(holders_[device], nullptr);
  holder.lost.insert(device);
  answer(holder, lost_text(device, why));
}

void Lobby::release(std::size_t device) {
  holders_[device] = nullptr;
  if (options_.controls.release) options_.controls.release(device);
}

void Lobby::act(Client&, const Set& set) {
  require(options_.controls.set, "change settings");
  const std::string reason = why_not(settings(), set.key, set.value);
  if (!reason.empty()) throw Error(reason);
  options_.controls.set(set.key, set.value);
  tell_settings();
}

void Lobby::act(Client&, const Preset& preset) {
  const ViewerControls& controls = options_.controls;
  require(controls.preset, "choose presets");
  if (std::ranges::find(controls.presets, preset.name) == controls.presets.end()) {
    throw Error("there is no such preset");
  }
  controls.preset(preset.name);
  tell_settings();
}

void Lobby::act(Client&, const Pause& pause) {
  require(options_.controls.pause, "pause");
  options_.controls.pause(pause.on);
}

void Lobby::act(Client&, const Reset&) {
  require(options_.controls.reset, "reset");
  options_.controls.reset();
}

void Lobby::act(Client&, const Record& record) {
  require(options_.controls.record, "record");
  const std::string file = options_.controls.record(record.on);
  recording_ = record.on ? file : "";
  tell_all({Topic::Kind::record}, text_message(record_text(record.on, file)));
}

void Lobby::act(Client& client, const Points& points) {
  client.points = points.points;
}

void Lobby::act(Client& client, const Ping& ping) {
  answer(client, pong_text(ping.id));
}

void Lobby::act(Client&, const Unreadable& unreadable) {
  throw Error(unreadable.text);
}

void Lobby::tell_all(Topic topic, Message message) {
  for (Client* client : greeted()) {
    client->outbox.put(topic, message);
    if (client->wake) client->wake();
  }
}

void Lobby::tell_settings() {
  tell_all({Topic::Kind::settings}, text_message(settings_text(settings())));
}

void Lobby::tell(const Notice& notice) {
  tell_all({Topic::Kind::answer}, text_message(notice_text(notice)));
}

void Lobby::end_record() {
  if (recording_.empty()) return;
  const std::string file = std::exchange(recording_, {});
  tell_all({Topic::Kind::record}, text_message(record_text(false, file)));
}

void Lobby::show(Client& client, Topic topic, const SharedBytes& bytes) {
  SharedBytes& shown = client.shown[topic];
  if (shown == bytes) return;
  shown = bytes;
  client.outbox.put(topic, {bytes, false});
  if (client.wake) client.wake();
}

std::vector<Client*> Lobby::greeted() const {
  std::vector<Client*> found;
  std::ranges::copy_if(clients_, std::back_inserter(found),
                       [](const Client* client) { return client->greeted && !client->closing; });
  return found;
}

void Lobby::answer(Client& client, std::string text) {
  client.outbox.put({Topic::Kind::answer}, text_message(std::move(text)));
  if (client.wake) client.wake();
}

void Lobby::refuse(Client& client, std::string_view text, double now) {
  ++refused_;
  answer(client, refused_text(text));
  if (client.refusals.exceeded(now)) {
    close(client, close_code::kPolicy, "too much that could not be understood");
  }
}

void Lobby::close(Client& client, std::uint16_t code, std::string reason) {
  client.closing = Closing{code, std::move(reason)};
  if (client.wake) client.wake();
}

std::vector<Setting> Lobby::settings() const {
  return options_.controls.settings ? options_.controls.settings() : std::vector<Setting>{};
}

}  // namespace palpate::viewer
