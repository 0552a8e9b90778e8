// The command bag: reports what an MCAP file holds and recovers damaged ones.
#include "apps/palpate/bag/bag_command.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <filesystem>
#include <map>
#include <optional>
#include <vector>

#include "apps/palpate/cli/arguments.hpp"
#include "apps/palpate/cli/checks.hpp"
#include "apps/palpate/cli/errors.hpp"
#include "apps/palpate/cli/output.hpp"
#include "apps/palpate/cli/terminal.hpp"
#include "apps/palpate/report/report.hpp"
#include "bag/mcap_check.hpp"
#include "bag/mcap_reader.hpp"
#include "bag/mcap_writer.hpp"
#include "sensor/bag_topics.hpp"

namespace palpate::app {

namespace {

constexpr const char* kBagFooter = R"(Examples:
  palpate bag info run.mcap
  palpate bag info run.mcap --check --json -
  palpate bag recover cut.mcap whole.mcap

Files are MCAP bags, of palpate, ROS 2 or any other program.

Exit codes: 0 done, 1 the file cannot be read or written, 2 the command line is wrong.)";

constexpr double kNanoseconds = 1e-9;  // s

double seconds_of(const bag::Contents& contents) {
  return contents.messages > 0 && contents.end > contents.start
             ? kNanoseconds * static_cast<double>(contents.end - contents.start)
             : 0;
}

std::string date(std::uint64_t time) {
  const auto seconds = static_cast<std::time_t>(time / 1'000'000'000);
  return fmt::format("{:%Y-%m-%d %H:%M:%S} UTC", fmt::gmtime(seconds));
}

// Messages a second; 0: there is no time between them.
double rate_of(const bag::Channel& channel, double seconds) {
  return channel.count > 1 && seconds > 0 ? static_cast<double>(channel.count - 1) / seconds : 0;
}

using Losses = std::vector<std::string>;  // in words

void add_losses(Report& report, const Losses& losses) {
  report.data["losses"] = losses;
  for (const std::string& loss : losses) report.note({"damaged", Mark::warning}, loss);
}

Losses with(Losses losses, const Losses& more) {
  losses.insert(losses.end(), more.begin(), more.end());
  return losses;
}

// None: it is damaged, which `losses` report.
std::optional<bag::Attachment> attachment_of(const bag::McapReader& reader, std::size_t index,
                                             Losses& losses) {
  try {
    return reader.attachment(index);
  } catch (const Error& error) {
    losses.emplace_back(error.what());
    return std::nullopt;
  }
}

void add_topics(Report& report, const bag::Contents& contents) {
  const double seconds = seconds_of(contents);
  Json& topics = report.data["topics"] = Json::array();
  for (const auto& [number, channel] : contents.channels) {
    report.item("topics", "topics", "{topic} ({type}): {messages} messages[, {rate_hz}]",
                channel.topic, channel.schema.name, channel.count, rate_of(channel, seconds));
    topics.back().update(
        {{"encoding", channel.message_encoding}, {"schema_encoding", channel.schema.encoding}});
  }
}

Report report_of(const std::string& path, const bag::Contents& contents, bool checked) {
  const bool any = contents.messages > 0;
  Report report(path, fmt::format("MCAP, profile '{}', written by {}", contents.profile,
                                  contents.library.empty() ? "?" : contents.library));
  report.data = {{"file", path},
                 {"profile", contents.profile},
                 {"library", contents.library},
                 {"closed", contents.closed},
                 {"checked", checked},
                 {"start_ns", any ? Json(contents.start) : Json()}};
  report.row("messages", "{messages} in {chunks} chunks", contents.messages,
             contents.chunks.size());
  report.row("time", "[{?}{}, {duration_s} long]", any, date(contents.start), seconds_of(contents));
  add_topics(report, contents);
  report.data["attachments"] = Json::array();
  for (const bag::AttachmentSpan& span : contents.attachments) {
    report.item("attachments", "attached", "{name}, {bytes} bytes", span.head.name, span.size);
  }
  add_losses(report, contents.losses);
  if (contents.losses.empty()) {
    report.note("damaged", checked ? "nothing" : "nothing seen; --check reads all of it");
  }
  return report;
}

// The file of a bag, which may be named by the folder that ROS 2 recorded it into.
std::string file_in(const std::string& path) {
  const std::vector<std::string> files = sensor::recorded_files(path);
  if (files.size() == 1) return files.front();
  throw Error(fmt::format("{}: this recording was split into several MCAP files; name one: {}",
                          path, fmt::join(files, ", ")));
}

void print_info(const BagCommand& command) {
  check_distinct({{"the bag", command.input}}, {{"--json", command.json}});
  std::optional<OutputFile> json;
  if (!command.json.empty()) json.emplace(command.json);
  const std::string path = file_in(command.input);
  bag::McapReader reader(path);
  if (command.check) {
    const Waiting waiting("reading " + command.input);
    for (bag::Message message; reader.next(message);) continue;
  }
  bag::Contents contents = reader.contents();
  if (command.check) bag::check(bag::RandomFile(path), contents);
  Report report = report_of(path, contents, command.check);
  report.print(command.json == "-" ? stderr : stdout);
  write_whole(json, text_of(report.data));
}

void recover(const BagCommand& command) {
  std::error_code unknown;
  if (std::filesystem::exists(command.output, unknown)) {
    throw UsageError(
        fmt::format("{} already exists and is not overwritten; name another file or remove it",
                    command.output));
  }
  const Waiting waiting("reading " + command.input);
  bag::McapReader reader(file_in(command.input));
  const bag::Contents& contents = reader.contents();
  bag::McapWriter writer(command.output, {.profile = contents.profile});
  std::map<std::uint16_t, std::uint16_t> numbers;
  for (const auto& [number, channel] : contents.channels) {
    numbers[number] = writer.add_channel(channel);
  }
  std::size_t messages = 0;
  for (bag::Message message; reader.next(message); ++messages) {
    writer.write(numbers.at(message.channel), message.stamp, message.data);
  }
  Losses unread;
  for (std::size_t i = 0; i < contents.attachments.size(); ++i) {
    if (const auto attachment = attachment_of(reader, i, unread)) writer.attach(*attachment);
  }
  for (const bag::Metadata& each : contents.metadata) writer.add(each);
  writer.close();
  Report report(command.output, "");
  report.note("messages", grouped(messages));
  add_losses(report, with(contents.losses, unread));
  report.print(stdout);
}

}  // namespace

void add_bag_options(CLI::App& command, BagCommand& bag) {
  command.require_subcommand(0, 1);
  command.footer(kBagFooter);
  bag.info = command.add_subcommand("info", "Topics, types, counts and rates, and what is damaged");
  bag.recover = command.add_subcommand(
      "recover", "Write what can be read of a damaged or unfinished bag to a new one");
  for (CLI::App* each : {bag.info, bag.recover}) {
    each->add_option("file", bag.input, "an MCAP file, or the folder that ROS 2 recorded it into")
        ->required()
        ->type_name("FILE");
  }
  bag.info->add_flag("--check", bag.check,
                     "read all of it, and check its CRCs and indexes against what is there");
  add_json_option(*bag.info, bag.json);
  bag.recover->add_option("output", bag.output, "the new file; never overwrites one")
      ->required()
      ->type_name("OUTPUT");
}

void bag(const BagCommand& bag) {
  if (bag.info->parsed()) return print_info(bag);
  if (bag.recover->parsed()) return recover(bag);
  throw UsageError(
      "nothing to do with a bag is given; use info or recover (see 'palpate bag --help')");
}

}  // namespace palpate::app
