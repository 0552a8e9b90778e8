// Tells a tab's page of a run.
#include "tab/tab_page.hpp"

#include <algorithm>
#include <array>
#include <limits>
#include <set>
#include <utility>
#include <variant>

namespace palpate::tab {
namespace {

using session::Setting;

struct Example {
  const char* name;
  const char* opened;
};

// One scan, one formula, one camera and one room: each is prepared within a second.
constexpr std::array<Example, 4> kExamples = {{{"rabbit", "synthetic:rabbit"},
                                               {"torus", "synthetic:torus"},
                                               {"desk", "camera:simulated:desk"},
                                               {"room", "synthetic:room"}}};

// A quarter of the memory that a tab may have, 2 GB: a file's bytes, its cloud and what is made of
// it are there at once.
constexpr std::size_t kLargestFile = 512 << 20;

constexpr std::size_t kMostNews = 8;  // that wait for a page: more nobody reads (judgement)

// Nobody else can speak to a worker; what a page says while a cloud is prepared comes at once
// afterwards, so how much it says in a second is no sign of an attack.
ViewerOptions completed(ViewerOptions options) {
  options.token = "tab";
  options.limits.file = kLargestFile;
  options.limits.messages = std::numeric_limits<int>::max();
  return options;
}

// The worker opens files; this is there so that the page offers it.
ViewerControls completed(ViewerControls controls) {
  controls.open = [](const std::string&, const std::string&) {};
  return controls;
}

}  // namespace

Setting scene_setting(const std::string& present) {
  Setting setting{.key = "scene", .label = "Scene", .kind = Setting::Kind::choice};
  for (const Example& each : kExamples) setting.choices.emplace_back(each.name);
  if (!std::ranges::count(setting.choices, present)) setting.choices.push_back(present);
  setting.value = present;
  setting.restarts = true;
  return setting;
}

std::string name_of_scene(const Setting::Value& value) {
  const auto& name = std::get<std::string>(value);
  const auto example =
      std::ranges::find_if(kExamples, [&](const Example& each) { return each.name == name; });
  return example == kExamples.end() ? name : example->opened;
}

TabPage::TabPage(Scene& scene, std::vector<Servo*> servos, const ViewerOptions& options,
                 const ViewerControls& controls, Outside outside, const Clock& stopwatch,
                 std::string news)
    : outside_(std::move(outside)),
      stopwatch_(stopwatch),
      view_(scene, std::move(servos), completed(options), completed(controls)),
      encoder_(scene, view_.encoding()) {
  if (!news.empty()) warn(news);
}

void TabPage::connect(double now) {
  leave();
  page_.emplace(view_.options().limits, now);
  sessions().join(*page_);
}

void TabPage::receive(std::string_view text, double now) {
  if (!page_) return;
  sessions().receive(*page_, text, now);
  flush();
}

void TabPage::warn(const std::string& words) {
  if (!view_.budgets().empty()) {
    sessions().send({Viewer::NoticeLevel::warning, words});
  } else if (news_.size() < kMostNews && !std::ranges::count(news_, words)) {
    news_.push_back(words);
  }
}

void TabPage::tell(double now) {
  tell_news(now);
  sessions().check(now);
  flush();
}

void TabPage::tell_news(double now) {
  if (now - done_.states >= view_.kStatePeriod) {
    done_.states = now;
    view_.send_states(now);
  }
  if (now - done_.reports >= view_.kReportPeriod) {
    done_.reports = now;
    view_.send_faults();
  }
  const std::set<std::size_t> budgets = view_.budgets();
  if (budgets.empty()) return;
  for (const std::string& words : std::exchange(news_, {})) warn(words);
  if (now < done_.next_picture) return;
  const double begin = stopwatch_.now();
  view_.show(encoder_.encode(budgets, now));
  done_.next_picture = now + viewer::SceneEncoder::pause_after(stopwatch_.now() - begin);
}

void TabPage::flush() {
  if (!page_) return;
  while (const auto message = page_->outbox.take()) outside_.say(*message->bytes, message->text);
  if (!page_->closing) return;
  const viewer::Closing closing = *page_->closing;
  leave();
  outside_.close(closing.code, closing.reason);
}

void TabPage::leave() {
  if (page_) sessions().leave(*page_);
  page_.reset();
}

}  // namespace palpate::tab
