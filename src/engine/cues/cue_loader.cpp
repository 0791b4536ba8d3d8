// CueLoader: files, errors, and the exchange of the list between two ticks.
#include "engine/cues/cue_loader.h"

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <system_error>
#include <utility>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/log/log.h"
#include "base/plural.h"
#include "base/system/file.h"
#include "base/text.h"
#include "engine/cues/cue_edit.h"

namespace limber::engine {

std::string CueLoader::path_for(const std::string& scene) {
  return std::filesystem::path(scene).replace_extension(".cues.json").string();
}

// Notes the content of the file, so that a watch finds changes since.
Result<CueLoader::List> CueLoader::read(const std::string& path, bool required) {
  script::SourceFile file{path, {}};
  std::error_code error;
  Result<CueList> cues = CueList{};
  if (required || std::filesystem::exists(path, error)) {
    const Result<std::string> text = system::read_file(path, kMaxBytes);
    if (text) file.content = hash_bytes(*text);
    cues = text ? parse_cues(*text) : Result<CueList>(Error{text.error()});
  }
  {
    const std::scoped_lock lock(mutex_);
    file_ = std::move(file);
  }
  if (!cues) return Error{cues.error()};
  return std::make_shared<const CueList>(std::move(*cues));
}

Result<void> CueLoader::start() {
  const bool given = !show_.options.files.cues.empty();
  if (!given && show_.options.scene.empty()) return {};
  const std::string path = given ? show_.options.files.cues : path_for(show_.options.scene);
  const Result<List> list = read(path, given);
  if (list) {
    show_.cues.set_list(*list, path);
    return {};
  }
  if (given) return Error{fmt::format("--cues {}: {}", printable(path), list.error())};
  show_.cues.set_list(show_.cues.list(), path);
  report(path, list.error());
  return {};
}

bool CueLoader::reload() {
  const std::string path = file().path;
  if (path.empty()) return true;
  const Result<List> list = read(path, true);
  if (!list) {
    report(path, list.error());
    return true;
  }
  const Result<void> done = scenes_.run_between_ticks([&] { apply(*list, false); });
  if (done) log_info("{}: {} loaded", printable(path), counted((*list)->size(), "cue"));
  return done.ok();
}

Result<void> CueLoader::edit(const Message& request) {
  namespace fs = std::filesystem;
  std::string path = file().path;
  if (path.empty()) return Error{"this show has no scene file, so it has no cue file"};
  std::error_code error;
  if (fs::is_symlink(path, error)) {
    const fs::path real = fs::canonical(path, error);
    if (error || real.parent_path() != fs::canonical(fs::path(path).parent_path(), error))
      return Error{fmt::format("{} is a link to another folder; put a file in its place", printable(path))};
    path = real.string();
  }
  const std::optional<system::FileStatus> status = system::file_status(path);
  const Result<std::string> text = status ? system::read_file(path, kMaxBytes) : Result<std::string>(std::string());
  const auto fault = [&](const std::string& why) { return Error{fmt::format("{}: {}", printable(path), why)}; };
  if (!text) return fault(text.error());
  std::size_t current = 0;
  Result<void> idle = scenes_.run_between_ticks([&] { current = show_.cues.position(); });
  if (!idle) return idle;
  const Result<std::string> edited = edited_cues(*text, request, current);
  if (!edited) return fault(edited.error());
  const std::string temporary = path + ".tmp";
  Result<void> written = system::replace_file(temporary, *edited, status ? status->permissions : 0644u);
  if (written && std::rename(temporary.c_str(), path.c_str()) != 0) written = Error{system::error_reason()};
  if (!written) {
    system::remove_file(temporary);
    return fault(written.error());
  }
  reload();
  return {};
}

void CueLoader::change_scene(const std::string& scene) {
  if (!show_.options.files.cues.empty()) return;
  const std::string path = path_for(scene);
  Result<List> list = read(path, false);
  if (!list) report(path, list.error());
  if (!list) list = std::make_shared<const CueList>();
  (void)scenes_.run_between_ticks([&] { apply(*list, true); });
}

script::SourceFile CueLoader::file() const {
  const std::scoped_lock lock(mutex_);
  return file_;
}

// Replaces the list, and records the numbers that the last cue and the waiting one have in it. `restart`: no cue has
// run.
void CueLoader::apply(const List& list, bool restart) {
  CuePlayer& cues = show_.cues;
  const std::string waiting = cues.waiting_name();
  cues.set_list(list, file().path);
  CueState state = restart ? CueState{} : cues.state();
  if (!restart) {
    const auto found = std::ranges::find(*list, waiting, &Cue::name);
    state.number = cues.position();
    state.waiting = found == list->end() ? 0 : static_cast<std::uint32_t>(found - list->begin()) + 1;
  }
  if (state == cues.state()) return;
  show_.input->record(message_of(state), {}, false);
  show_.set_cue_state(std::move(state));
}

void CueLoader::report(const std::string& path, const std::string& why) const {
  const std::string text = fmt::format("{}: {}", printable(path), why);
  log_error("{}; the cues that were loaded before stay", text);
  show_.link.push_out({Outgoing::Destination::error, {}, error_message("/cue", text)});
}

}  // namespace limber::engine
