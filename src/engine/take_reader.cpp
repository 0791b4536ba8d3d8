// Frame by frame; the first that is not whole ends the take.
#include "engine/take_reader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/preset_text.h"

namespace limber {

namespace {

constexpr std::size_t kMostLine = 65536;  // of the head

// up to the line's end, which is left out; false: there is none
bool read_line(std::istream& in, std::string& line) {
  line.clear();
  for (int c = in.get(); c != std::istream::traits_type::eof() && line.size() < kMostLine; c = in.get()) {
    if (c == '\n') return true;
    line.push_back(static_cast<char>(c));
  }
  return false;
}

}  // namespace

Result<std::unique_ptr<TakeReader>> TakeReader::open(const std::string& path) {
  std::error_code fault;
  if (!std::filesystem::is_regular_file(path, fault))
    return Error{fmt::format("{}: there is no such take; give the path of the file", printable(path))};
  auto in = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*in) return Error{fmt::format("{}: it can't be read; look at its permissions", printable(path))};
  return of(std::move(in), path);
}

Result<std::unique_ptr<TakeReader>> TakeReader::of(std::unique_ptr<std::istream> in, const std::string& name) {
  std::unique_ptr<TakeReader> reader(new TakeReader(name));
  reader->in_ = std::move(in);
  reader->in_->seekg(0, std::ios::end);
  reader->size_ = static_cast<std::uint64_t>(std::max<std::streamoff>(0, reader->in_->tellg()));
  reader->in_->seekg(0);
  if (const Result<void> head = reader->read_head(); !head)
    return Error{fmt::format("{}: {}", printable(name), head.error())};
  return reader;
}

Result<void> TakeReader::read_head() {
  std::string first;
  std::string second;
  const bool whole = read_line(*in_, first) && read_line(*in_, second);
  // a file of something else may have no lines at all
  if (!first.starts_with(std::string_view(kTakeHead).substr(0, first.size())) || first.empty())
    return Error{"this is no take of Limber"};
  if (!whole) return Error{"the take was cut off before it began; nothing of it can be played"};
  Result<TakeHeader> header = header_of(first, second);
  if (!header) return Error{header.error()};
  header_ = std::move(*header);
  position_ = first.size() + second.size() + 2;
  const std::optional<TakeFrame> kind = frame();
  if (!kind && damage_.empty()) return Error{"the take was cut off before it began; nothing of it can be played"};
  if (!kind) return Error{damage_};
  if (*kind != TakeFrame::begin || !read_begin(payload_, begin_))
    return Error{"the take's beginning is damaged; nothing of it can be played"};
  return {};
}

void TakeReader::damaged(const std::string& what) {
  damage_ = fmt::format("damaged at byte {}: {}; what comes before is good", position_, what);
}

bool TakeReader::bytes(std::size_t count, std::string& out) {
  out.resize(count);
  return static_cast<bool>(in_->read(out.data(), static_cast<std::streamsize>(count)));
}

std::optional<TakeReader::FrameHead> TakeReader::frame_head() {
  if (!damage_.empty() || position_ >= size_) return {};
  const int first = in_->get();
  std::uint64_t length = 0;
  std::uint64_t read = 1;
  for (unsigned shift = 0;; shift += 7, read++) {
    const int c = in_->get();
    if (c == std::istream::traits_type::eof()) return {};
    length |= static_cast<std::uint64_t>(c & 0x7f) << shift;
    if ((c & 0x80) == 0) break;
    if (shift >= 56) return damaged("no frame is that long"), std::nullopt;
  }
  read += 1;
  // one that the file's end cuts off is no damage
  if (length > size_ || position_ + read + length + 4 > size_) {
    const std::string_view kinds = "cfbte";
    if (kinds.find(static_cast<char>(first)) == kinds.npos) damaged("no frame begins like this");
    return {};
  }
  return FrameHead{first, length, read};
}

std::optional<TakeFrame> TakeReader::frame() {
  const std::optional<FrameHead> head = frame_head();
  if (!head) return {};
  std::string check;
  if (!bytes(static_cast<std::size_t>(head->length), payload_) || !bytes(4, check)) return {};
  const auto kind = static_cast<TakeFrame>(head->kind);
  if (TakeScan(check).word(4) != frame_check(kind, payload_)) return damaged("a checksum is wrong"), std::nullopt;
  position_ += head->bytes + head->length + 4;
  return kind;
}

bool TakeReader::next(TakeTick& tick) {
  while (!over_) {
    const std::uint64_t before = position_;
    const std::optional<TakeFrame> kind = frame();
    if (kind && !take_frame(*kind, tick)) {
      position_ = before;
      damaged("a frame has no meaning");
    }
    over_ = !kind || end_ || !damage_.empty();
    if (!over_ && *kind == TakeFrame::tick) return true;
  }
  return false;
}

std::uint64_t TakeReader::count_ticks() {
  std::uint64_t count = 0;
  while (const std::optional<FrameHead> head = frame_head()) {
    const bool tick = static_cast<TakeFrame>(head->kind) == TakeFrame::tick && head->length > 0;
    if (tick && tick_runs(static_cast<std::uint8_t>(in_->get()))) count++;
    in_->ignore(static_cast<std::streamsize>(head->length + 4 - (tick ? 1 : 0)));
    position_ += head->bytes + head->length + 4;
  }
  return count;
}

bool TakeReader::take_frame(TakeFrame kind, TakeTick& tick) {
  if (kind == TakeFrame::tick) {
    if (!read_tick(payload_, forms_, tick)) return false;
    for (const TakeRun& run : tick.runs) {
      if (run.files > lists_.size()) return false;
    }
    return true;
  }
  if (kind == TakeFrame::content) {
    contents_.push_back(std::make_shared<const std::string>(payload_));
    return true;
  }
  if (kind == TakeFrame::files) {
    TakeFileList list;
    if (!read_files(payload_, list)) return false;
    for (const auto& [path, content] : list.files) {
      if (content > contents_.size()) return false;
    }
    lists_.push_back(std::move(list));
    return true;
  }
  if (kind != TakeFrame::end) return false;
  TakeEnd end;
  if (!read_end(payload_, end)) return false;
  end_ = end;
  return true;
}

std::size_t TakeReader::content_size(std::uint32_t content) const {
  return content == 0 || content > contents_.size() ? 0 : contents_[content - 1]->size();
}

std::shared_ptr<const Sources> TakeReader::sources(std::uint32_t files) {
  if (files == 0 || files > lists_.size()) return nullptr;
  sources_.resize(lists_.size());
  std::shared_ptr<const Sources>& made = sources_[files - 1];
  if (made != nullptr) return made;
  const TakeFileList& list = lists_[files - 1];
  // runs of the same files share them, and what was made of them
  for (std::size_t i = 0; i < sources_.size(); i++) {
    if (sources_[i] != nullptr && lists_[i] == list) return made = sources_[i];
  }
  auto set = std::make_shared<FileSet>();
  set->found = list.meshes;
  for (const auto& [path, content] : list.files) {
    if (content != 0) set->contents[path] = contents_[content - 1];
  }
  // a reload tells a model that changed by its being another one
  TakeFileList of_models{{}, list.meshes, {}, false, "", ""};
  for (const auto& file : list.files) {
    if (!file.first.ends_with(".lua")) of_models.files.push_back(file);
  }
  std::shared_ptr<ModelLibrary>& library = libraries_[text_of(of_models)];
  if (library == nullptr) library = std::make_shared<ModelLibrary>(set);
  made = std::make_shared<const Sources>(list.found, set, library);
  return made;
}

std::optional<TakeReader::PresetBook> TakeReader::presets(std::uint32_t files) const {
  if (files == 0 || files > lists_.size() || !lists_[files - 1].has_presets) return {};
  PresetBook book{{}, lists_[files - 1].preset_file};
  Result<PresetsRead> read = presets_of(lists_[files - 1].presets);
  if (read) book.list = std::move(read->presets);
  return book;
}

}  // namespace limber
