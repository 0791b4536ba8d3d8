// The child process: its start, the requests to it and its answers.
#include "app/breed/variation_process.h"

#include <array>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/system/file.h"
#include "base/text.h"

namespace limber::app {

namespace {

constexpr std::size_t kMaxHeader = std::size_t{1} << 16;  // bytes

}  // namespace

void VariationProcess::play(experiments::Evaluation evaluation) {
  evaluation_ = std::move(evaluation);
  sent_ = false;
  starts_ = 0;
  has_image_ = false;
  error_.clear();
}

bool VariationProcess::start() {
  if (starts_ >= kMaxStarts) return false;
  starts_++;
  process_ = std::make_unique<system::ChildProcess>();
  received_.clear();
  set_up_ = sent_ = awaits_ = false;
  const int fault = process_->start_quietly(command_);
  if (fault == 0) return true;
  process_.reset();
  error_ = fmt::format("{} can't be started: {}", printable(command_.front()), std::generic_category().message(fault));
  return false;
}

void VariationProcess::lose(const char* reason) {
  process_.reset();
  awaits_ = false;
  if (starts_ >= kMaxStarts) error_ = reason;
}

void VariationProcess::request(const ImageRequest& request, double now) {
  if (awaits_ || (process_ == nullptr && !start())) return;
  std::string text;
  if (!std::exchange(set_up_, true)) text += experiments::encode(setup_) + "\n";
  if (!std::exchange(sent_, true)) text += experiments::encode(evaluation_) + "\n";
  text += encode(request) + "\n";
  awaits_ = true;
  asked_at_ = now;
  // if the process no longer reads, its output ends, which read() notices
  (void)process_->write(text);
}

void VariationProcess::check(double now) {
  if (awaits_ && now - asked_at_ > kAnswerLimit) lose("the simulation doesn't answer");
}

bool VariationProcess::read() {
  if (process_ == nullptr) return false;
  std::array<char, 1 << 16> buffer;
  const std::ptrdiff_t size = system::read_some(process_->output(), buffer.data(), buffer.size());
  if (size <= 0) {
    lose("the simulation has ended unexpectedly");
    return false;
  }
  received_.append(buffer.data(), static_cast<std::size_t>(size));
  return take_message();
}

// Takes a complete answer from the received bytes.
bool VariationProcess::take_message() {
  const std::size_t end = received_.find('\n');
  if (end == std::string::npos) {
    if (received_.size() > kMaxHeader) lose("the simulation answers nonsense");
    return false;
  }
  std::optional<ImageHeader> header = decode_image_header(std::string_view(received_).substr(0, end));
  if (!header) {
    lose("the simulation answers nonsense");
    return false;
  }
  if (received_.size() < end + 1 + header->bytes()) return false;
  awaits_ = false;
  // an answer of the run before says nothing about this one
  const bool current = sent_ && header->number == evaluation_.number;
  if (current) error_ = std::move(header->error);
  const bool has_image = current && header->width > 0;
  if (has_image) {
    has_image_ = true;
    image_.width = header->width;
    image_.height = header->height;
    image_.bytes.assign(received_.begin() + static_cast<std::ptrdiff_t>(end) + 1, received_.end());
    image_.bytes.resize(header->bytes());
  }
  received_.clear();
  return has_image;
}

}  // namespace limber::app
