// LiveOutput: messages to the queues of their receivers, counters, and reports that are made once.
#include "engine/output/show_output.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"

namespace limber::engine {

void LiveOutput::push(Outgoing out) {
  const bool answer =
      out.destination == Outgoing::Destination::reply || out.destination == Outgoing::Destination::error;
  if (answer && answers_muted_) return;
  link_.push_out(std::move(out));
}

void LiveOutput::configure_osc(const OscConfig& config) {
  const std::shared_ptr<OscConfig> published = link_.osc_config.acquire_buffer();
  *published = config;
  link_.osc_config.publish(published);
  link_.wake_network();
}

void LiveOutput::send_error(const Message& message, const CommandOrigin& origin, std::string_view error) {
  // messages of cues have no sender
  if (origin.source == CommandSource::script)
    return warn_once(fmt::format("cue: {}: {}", printable(message.address), error));
  push({Outgoing::Destination::error, origin, error_message(message.address, error)});
}

void LiveOutput::report_clamped(const Message& message, const Property& property) {
  if (std::find(reported_clamped_.begin(), reported_clamped_.end(), &property) != reported_clamped_.end()) return;
  reported_clamped_.push_back(&property);
  log_warning("{}: value clamped to {} (reported once for {})", printable(message.address), range_text(property),
              property.name);
}

// A slider on a preset would fill the log.
void LiveOutput::warn_once(const std::string& text) {
  constexpr std::size_t kMaxTexts = 64;
  if (std::find(reported_warnings_.begin(), reported_warnings_.end(), text) != reported_warnings_.end()) return;
  if (reported_warnings_.size() >= kMaxTexts) reported_warnings_.erase(reported_warnings_.begin());
  reported_warnings_.push_back(text);
  log_warning("{} (reported once)", text);
}

void LiveOutput::warn_sender(const Message& message, const CommandOrigin& origin, const std::string& warning) {
  warn_once(warning);
  send_error(message, origin, warning);
}

void LiveOutput::report_rejected(const Message& message, const CommandOrigin& origin, std::string_view error) {
  count(&Counters::refused);
  faults_++;
  send_error(message, origin, error);
}

void LiveOutput::report_unknown(const Message& message, const CommandOrigin& origin, std::string_view error) {
  count(&Counters::unknown);
  send_error(message, origin, error);
}

void LiveOutput::report_fault(const std::string& text) {
  faults_++;
  log_error("{}", text);
}

bool LiveOutput::report_script_error(std::string_view file, int line, std::string_view text) {
  if (text.empty()) {
    push({Outgoing::Destination::event, {}, {"/script/ok", {Arg::of(file)}}});
    log_info("{}{}", file, kResolvedSuffix);
    return true;
  }
  faults_++;
  log_line(LogLevel::error, text, fmt::format("{}:{}", file, line));
  push({Outgoing::Destination::event,
        {},
        {"/script/error",
         {Arg::of(file), Arg::of(static_cast<double>(line)), Arg::of(shortened(text, kMaxErrorText))}}});
  return true;
}

}  // namespace limber::engine
