// Answers pages' messages and keeps track of which page holds which tool.
#include "viewer/client_sessions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <memory>
#include <utility>
#include <variant>

#include "viewer/access.hpp"

namespace palpate::viewer {
namespace {

std::string why_not(const Setting& setting, double value) {
  if (setting.kind == Setting::Kind::choice) return "give one of the words, not a number";
  if (setting.kind == Setting::Kind::on_off) return "it is not true or false";
  if (value >= setting.least && value <= setting.most) return {};
  return fmt::format("{} is not from {} to {}", value, setting.least, setting.most);
}

std::string why_not(const Setting& setting, const std::string& value) {
  if (setting.kind == Setting::Kind::number) return "give a number, not text";
  if (setting.kind == Setting::Kind::on_off) return "it is not true or false";
  if (std::ranges::find(setting.choices, value) != setting.choices.end()) return {};
  return fmt::format("there are only {}", fmt::join(setting.choices, ", "));
}

std::string why_not(const Setting& setting, bool) {
  return setting.kind == Setting::Kind::on_off ? "" : "it is not true or false";
}

// Why `key` cannot be set to `value`, in words; empty: it can.
std::string why_not(std::span<const Setting> settings, const std::string& key,
                    const Setting::Value& value) {
  const auto found = std::ranges::find(settings, key, &Setting::key);
  if (found == settings.end()) return "unknown setting";
  const std::string reason =
      std::visit([&](const auto& given) { return why_not(*found, given); }, value);
  return reason.empty() ? "" : fmt::format("{}: {}", found->label, reason);
}

Message text_message(std::string text) {
  return {std::make_shared<const std::string>(std::move(text)), true};
}

template <class Function>
void require(const Function& function, const char* what) {
  if (!function) throw Error(fmt::format("this program does not allow a page to {}", what));
}

}  // namespace

void ClientSessions::leave(Session& session) {
  std::erase(sessions_, &session);
  for (std::size_t device = 0; device < holders_.size(); ++device) {
    if (holders_[device] != &session) continue;
    try {
      release(device);
    } catch (const std::exception&) {
      continue;  // the client that would have to know is gone
    }
  }
}

void ClientSessions::receive(Session& session, std::string_view text, double now) {
  if (session.closing) return;
  session.heard = now;
  if (session.messages.exceeded(now)) {
    refuse(session, fmt::format("more than {} messages per second", options_.limits.messages), now);
    return;
  }
  try {
    const ClientMessage message = read_message(text);
    const bool hello = std::holds_alternative<Hello>(message);
    if (!session.greeted && !hello) throw Error("send hello first");
    if (session.greeted && hello) throw Error("hello was already sent");
    std::visit([&](const auto& read) { act(session, read); }, message);
  } catch (const std::exception& error) {
    refuse(session, error.what(), now);
  }
}

void ClientSessions::receive_binary(Session& session, double now) {
  if (!session.closing) refuse(session, "binary message; send JSON", now);
}

void ClientSessions::check(double now) {
  for (Session* session : sessions_) {
    const bool late = !session->greeted && now - session->opened > options_.limits.hello_time;
    if (late && !session->closing) close(*session, close_code::kTryAgainLater, "no hello in time");
  }
  for (std::size_t device = 0; device < holders_.size(); ++device) {
    const Session* holder = holders_[device];
    if (holder == nullptr || now - holder->heard <= options_.limits.hand_silence) continue;
    lose(device, fmt::format("no message from this page for {} s: the tool was released",
                             options_.limits.hand_silence));
    release(device);
  }
}

void ClientSessions::act(Session& session, const Hello& hello) {
  if (!same_token(hello.token, options_.token)) {
    ++wrong_tokens_;
    close(session, close_code::kPolicy, "wrong token; use the address that the program printed");
    return;
  }
  if (greeted().size() >= options_.limits.clients) {
    ++turned_away_;
    const std::string words =
        fmt::format("{} pages are already connected; close one of them", options_.limits.clients);
    answer(session, refused_text(words));
    return close(session, close_code::kTryAgainLater, words);
  }
  welcome(session);
  session.greeted = true;
  session.points = hello.points;
}

void ClientSessions::welcome(Session& session) {
  Welcome welcome = options_.welcome();
  welcome.devices = options_.devices;
  welcome.settings = settings();
  const ViewerControls& controls = options_.controls;
  welcome.presets = controls.presets;
  welcome.opens = controls.open ? options_.limits.file : 0;
  if (controls.time_line) welcome.time_line = controls.time_line->length;
  answer(session, welcome_text(welcome));
  for (const Notice& notice : welcome.notices) answer(session, notice_text(notice));
  if (!recording_.empty()) {
    session.outbox.put({Topic::Kind::record}, text_message(record_text(true, recording_)));
  }
  moment_.reset();  // for the new one
  show_time_line({&session});
}

void ClientSessions::act(Session& session, const Hand& hand) {
  require(options_.controls.hand, "move the tool");
  if (hand.device >= holders_.size() || !options_.devices[hand.device].takeable) {
    throw Error(fmt::format("no tool {} that a page can move", hand.device));
  }
  if (session.lost.contains(hand.device)) return;  // said before it knew
  TargetSource::Target target = hand.target;
  target.position += options_.origin;
  options_.controls.hand(hand.device, target);
  Session* const before = holders_[hand.device];
  if (before != nullptr && before != &session) lose(hand.device, "another page took the tool");
  holders_[hand.device] = &session;
}

// If the tool was taken away meanwhile, the release says that the client knows it now.
void ClientSessions::act(Session& session, const Release& wish) {
  if (wish.device >= holders_.size()) throw Error("unknown tool");
  session.lost.erase(wish.device);
  if (holders_[wish.device] == &session) release(wish.device);
}

void ClientSessions::lose(std::size_t device, std::string_view why) {
  Session& holder = *std::exchange(holders_[device], nullptr);
  holder.lost.insert(device);
  answer(holder, lost_text(device, why));
}

void ClientSessions::release(std::size_t device) {
  holders_[device] = nullptr;
  if (options_.controls.release) options_.controls.release(device);
}

void ClientSessions::act(Session&, const Set& set) {
  require(options_.controls.set, "change settings");
  const std::string reason = why_not(settings(), set.key, set.value);
  if (!reason.empty()) throw Error(reason);
  options_.controls.set(set.key, set.value);
  send_settings();
}

void ClientSessions::act(Session&, const Preset& preset) {
  const ViewerControls& controls = options_.controls;
  require(controls.preset, "choose presets");
  if (std::ranges::find(controls.presets, preset.name) == controls.presets.end()) {
    throw Error("unknown preset");
  }
  controls.preset(preset.name);
  send_settings();
}

void ClientSessions::act(Session&, const Pause& pause) {
  require(options_.controls.pause, "pause");
  options_.controls.pause(pause.on);
}

void ClientSessions::act(Session&, const Reset& reset) {
  require(options_.controls.reset, "reset");
  if (reset.device.value_or(0) >= holders_.size()) throw Error("unknown tool");
  options_.controls.reset(reset.device);
}

void ClientSessions::act(Session&, const Record& record) {
  require(options_.controls.record, "record");
  const std::string file = options_.controls.record(record.on);
  recording_ = record.on ? file : "";
  send_to_all({Topic::Kind::record}, text_message(record_text(record.on, file)));
}

void ClientSessions::act(Session&, const Seek& seek) {
  require(options_.controls.time_line, "seek");
  options_.controls.time_line->seek(seek.time);
}

void ClientSessions::act(Session&, const Play& play) {
  require(options_.controls.time_line, "play a recording");
  options_.controls.time_line->play(play.on, play.speed);
}

void ClientSessions::send_moment() {
  const auto& line = options_.controls.time_line;
  if (!line) return;
  const TimeLine::Moment moment = line->moment();
  if (std::exchange(moment_, moment) == moment) return;
  send_to_all({Topic::Kind::time}, text_message(moment_text(moment)));
}

void ClientSessions::show_time_line(const std::vector<Session*>& sessions) const {
  const auto& line = options_.controls.time_line;
  if (!line) return;
  std::vector<std::pair<Topic, Message>> messages;
  messages.emplace_back(Topic{Topic::Kind::envelope},
                        text_message(envelope_text(line->envelope())));
  for (std::size_t i = 0; i < options_.devices.size(); ++i) {
    std::string past = encode_past(static_cast<std::uint8_t>(i), line->past(i));
    messages.emplace_back(Topic{Topic::Kind::past, i},
                          Message{std::make_shared<const std::string>(std::move(past)), false});
  }
  for (Session* session : sessions) {
    for (const auto& [topic, message] : messages) session->outbox.put(topic, message);
    if (session->wake) session->wake();
  }
}

void ClientSessions::send_to_all(Topic topic, const Message& message) {
  for (Session* session : greeted()) {
    session->outbox.put(topic, message);
    if (session->wake) session->wake();
  }
}

void ClientSessions::send_settings() {
  send_to_all({Topic::Kind::settings}, text_message(settings_text(settings())));
}

void ClientSessions::send(const Notice& notice) {
  send_to_all({Topic::Kind::answer}, text_message(notice_text(notice)));
}

void ClientSessions::end_record() {
  if (recording_.empty()) return;
  const std::string file = std::exchange(recording_, {});
  send_to_all({Topic::Kind::record}, text_message(record_text(false, file)));
}

void ClientSessions::show(Session& session, Topic topic, const SharedBytes& bytes) {
  SharedBytes& shown = session.shown[topic];
  if (shown == bytes) return;
  shown = bytes;
  session.outbox.put(topic, {bytes, false});
  if (session.wake) session.wake();
}

std::vector<Session*> ClientSessions::greeted() const {
  std::vector<Session*> found;
  std::ranges::copy_if(sessions_, std::back_inserter(found), [](const Session* session) {
    return session->greeted && !session->closing;
  });
  return found;
}

void ClientSessions::answer(Session& session, std::string text) {
  session.outbox.put({Topic::Kind::answer}, text_message(std::move(text)));
  if (session.wake) session.wake();
}

void ClientSessions::refuse(Session& session, std::string_view text, double now) {
  ++refused_;
  answer(session, refused_text(text));
  if (!session.refusals.exceeded(now)) return;
  close(session, close_code::kPolicy, "too many invalid messages");
}

void ClientSessions::close(Session& session, std::uint16_t code, std::string reason) {
  session.closing = Closing{code, std::move(reason)};
  if (session.wake) session.wake();
}

std::vector<Setting> ClientSessions::settings() const {
  return options_.controls.settings ? options_.controls.settings() : std::vector<Setting>{};
}

}  // namespace palpate::viewer
