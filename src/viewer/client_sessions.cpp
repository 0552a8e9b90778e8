// Answers pages' messages and keeps track of which page holds which tool.
#include "viewer/client_sessions.hpp"

#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <utility>
#include <variant>

#include "palpate/base/error.hpp"
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

std::vector<Setting> settings_of(const ViewerControls& controls) {
  return controls.settings ? controls.settings() : std::vector<Setting>{};
}

// `control`, which the program gives only if it allows a page to do that.
template <class Control>
const Control& allowed(const Control& control, const char* what) {
  if (!control) throw Error(fmt::format("this program does not allow a page to {}", what));
  return control;
}

void change(const ViewerControls& controls, const Set& set) {
  const auto& control = allowed(controls.set, "change settings");
  const std::string reason = why_not(settings_of(controls), set.key, set.value);
  if (!reason.empty()) throw Error(reason);
  control(set.key, set.value);
}

void change(const ViewerControls& controls, const Preset& preset) {
  const auto& control = allowed(controls.preset, "choose presets");
  if (std::ranges::find(controls.presets, preset.name) == controls.presets.end()) {
    throw Error("unknown preset");
  }
  control(preset.name);
}

Welcome welcome_of(const ClientSessionsOptions& options) {
  const ViewerControls& controls = options.controls;
  Welcome welcome = options.welcome();
  welcome.devices = options.devices;
  welcome.settings = settings_of(controls);
  welcome.presets = controls.presets;
  welcome.opens = controls.open ? options.limits.file : 0;
  if (controls.time_line) welcome.time_line = controls.time_line->length;
  return welcome;
}

// The envelope and each tool's past; nothing while a run is shown.
std::vector<std::pair<Topic, Message>> time_line_messages(const ClientSessionsOptions& options) {
  std::vector<std::pair<Topic, Message>> messages;
  const auto& line = options.controls.time_line;
  if (!line) return messages;
  messages.emplace_back(Topic{Topic::Kind::envelope},
                        text_message(envelope_text(line->envelope())));
  for (std::size_t i = 0; i < options.devices.size(); ++i) {
    messages.emplace_back(Topic{Topic::Kind::past, i},
                          binary_message(encode_past(static_cast<std::uint8_t>(i), line->past(i))));
  }
  return messages;
}

// Makes one function of several, one for each type of a message.
template <class... Functions>
struct Overloaded : Functions... {
  using Functions::operator()...;
};
template <class... Functions>
Overloaded(Functions...) -> Overloaded<Functions...>;

}  // namespace

void ToolHolders::move(Session& session, const Hand& hand) {
  const auto& control = allowed(options_.controls.hand, "move the tool");
  if (hand.device >= holders_.size() || !options_.devices[hand.device].takeable) {
    throw Error(fmt::format("no tool {} that a page can move", hand.device));
  }
  if (session.lost.contains(hand.device)) return;  // sent before it received the loss
  TargetSource::Target target = hand.target;
  target.position += options_.origin;
  std::optional<Eigen::Vector3d> eye = hand.eye;
  if (eye) *eye += options_.origin;
  control(hand.device, target, eye);
  Session* const before = holders_[hand.device];
  if (before != nullptr && before != &session) {
    before->lose(hand.device, "another page took the tool");
  }
  holders_[hand.device] = &session;
}

// If the tool was taken away meanwhile, the release confirms that the client received that.
void ToolHolders::release(Session& session, const Release& wish) {
  if (wish.device >= holders_.size()) throw Error("unknown tool");
  session.lost.erase(wish.device);
  if (holders_[wish.device] == &session) let_go(wish.device);
}

void ToolHolders::reset(const Reset& wish) const {
  const auto& control = allowed(options_.controls.reset, "reset");
  if (wish.device.value_or(0) >= holders_.size()) throw Error("unknown tool");
  control(wish.device);
}

void ToolHolders::leave(const Session& session) {
  for (std::size_t device = 0; device < holders_.size(); ++device) {
    try {
      if (holders_[device] == &session) let_go(device);
    } catch (const std::exception&) {
      continue;  // the client that would be notified is gone
    }
  }
}

void ToolHolders::check(double now) {
  for (std::size_t device = 0; device < holders_.size(); ++device) {
    Session* const holder = holders_[device];
    if (holder == nullptr || now - holder->received <= options_.limits.hand_silence) continue;
    holder->lose(device, fmt::format("no message from this page for {} s: the tool was released",
                                     options_.limits.hand_silence));
    let_go(device);
  }
}

void ToolHolders::let_go(std::size_t device) {
  holders_[device] = nullptr;
  if (options_.controls.release) options_.controls.release(device);
}

void ClientSessions::receive(Session& session, std::string_view text, double now) {
  if (session.closing) return;
  session.received = now;
  if (session.messages.exceeded(now)) {
    refuse(session, fmt::format("more than {} messages per second", options_.limits.messages), now);
    return;
  }
  try {
    const ClientMessage message = read_message(text);
    const bool hello = std::holds_alternative<Hello>(message);
    if (!session.greeted && !hello) throw Error("send hello first");
    if (session.greeted && hello) throw Error("hello was already sent");
    act(session, message);
  } catch (const std::exception& error) {
    refuse(session, error.what(), now);
  }
}

void ClientSessions::act(Session& session, const ClientMessage& message) {
  const ViewerControls& controls = options_.controls;
  std::visit(
      Overloaded{[&](const Unreadable& unreadable) { throw Error(unreadable.text); },
                 [&](const Hello& hello) { greet(session, hello); },
                 [&](const Hand& hand) { tools_.move(session, hand); },
                 [&](const Release& wish) { tools_.release(session, wish); },
                 [&](const Reset& wish) { tools_.reset(wish); },
                 [&](const Pause& pause) { allowed(controls.pause, "pause")(pause.on); },
                 [&](const Record& wish) { record(wish.on); },
                 [&](const Seek& seek) { allowed(controls.time_line, "seek")->seek(seek.time); },
                 [&](const Play& play) {
                   allowed(controls.time_line, "play a recording")->play(play.on, play.speed);
                 },
                 [&](const Points& points) { session.points = points.points; },
                 [&](const Ping& ping) { session.answer(pong_text(ping.id)); },
                 [&](const auto& set) {  // a setting or a preset
                   change(controls, set);
                   send_settings();
                 }},
      message);
}

void ClientSessions::refuse(Session& session, std::string_view why, double now) {
  if (session.closing) return;
  ++counts_.refused;
  session.answer(refused_text(why));
  if (!session.refusals.exceeded(now)) return;
  session.close(close_code::kPolicy, "too many invalid messages");
}

void ClientSessions::check(double now) {
  for (Session* session : sessions_) {
    const bool late = !session->greeted && now - session->opened > options_.limits.hello_time;
    if (late && !session->closing) session->close(close_code::kTryAgainLater, "no hello in time");
  }
  tools_.check(now);
}

void ClientSessions::greet(Session& session, const Hello& hello) {
  if (!same_token(hello.token, options_.token)) {
    ++counts_.forbidden;
    return session.close(close_code::kPolicy,
                         "wrong token; use the address that the program printed");
  }
  if (greeted().size() >= options_.limits.clients) {
    ++counts_.turned_away;
    const std::string words =
        fmt::format("{} pages are already connected; close one of them", options_.limits.clients);
    session.answer(refused_text(words));
    return session.close(close_code::kTryAgainLater, words);
  }
  const Welcome welcome = welcome_of(options_);
  session.answer(welcome_text(welcome));
  for (const Notice& notice : welcome.notices) session.answer(notice_text(notice));
  if (!recording_.empty()) {
    session.send({Topic::Kind::record}, text_message(record_text(true, recording_)));
  }
  moment_.reset();  // for the new one
  for (const auto& [topic, message] : time_line_messages(options_)) session.send(topic, message);
  for (std::size_t i = 0; i < welcome.devices.size(); ++i) {
    const auto& tool = welcome.devices[i].tool;
    if (tool == nullptr) continue;
    session.send({Topic::Kind::tool, i},
                 binary_message(encode_tool(static_cast<std::uint8_t>(i), *tool)));
  }
  session.greeted = true;
  session.points = hello.points;
}

void ClientSessions::record(bool on) {
  const std::string file = allowed(options_.controls.record, "record")(on);
  recording_ = on ? file : "";
  send_to_all({Topic::Kind::record}, text_message(record_text(on, file)));
}

void ClientSessions::end_record() {
  if (recording_.empty()) return;
  const std::string file = std::exchange(recording_, {});
  send_to_all({Topic::Kind::record}, text_message(record_text(false, file)));
}

void ClientSessions::send_moment() {
  const auto& line = options_.controls.time_line;
  if (!line) return;
  const TimeLine::Moment moment = line->moment();
  if (std::exchange(moment_, moment) == moment) return;
  send_to_all({Topic::Kind::time}, text_message(moment_text(moment)));
}

void ClientSessions::send_time_line() {
  for (const auto& [topic, message] : time_line_messages(options_)) send_to_all(topic, message);
}

void ClientSessions::send_envelope() {
  const auto& line = options_.controls.time_line;
  if (line) send_to_all({Topic::Kind::envelope}, text_message(envelope_text(line->envelope())));
}

void ClientSessions::send_to_all(Topic topic, const Message& message) {
  for (Session* session : greeted()) session->send(topic, message);
}

void ClientSessions::send_settings() {
  const std::vector<Setting> settings = settings_of(options_.controls);
  send_to_all({Topic::Kind::settings}, text_message(settings_text(settings)));
}

void ClientSessions::send(const Notice& notice) {
  send_to_all({Topic::Kind::answer}, text_message(notice_text(notice)));
}

std::vector<Session*> ClientSessions::greeted() const {
  std::vector<Session*> found;
  std::ranges::copy_if(sessions_, std::back_inserter(found), [](const Session* session) {
    return session->greeted && !session->closing;
  });
  return found;
}

}  // namespace palpate::viewer
