// Reads frame by frame; the first incomplete or corrupt frame ends the take.
#include "engine/takes/reader.h"

#include <algorithm>
#include <filesystem>
#include <fstream>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "engine/presets/text.h"

namespace limber::engine {

namespace {

constexpr std::size_t kMaxLine = 65536;  // longest line of the header, in bytes

// Reads up to the end of the line, which is not included. False if there is none.
bool read_line(std::istream& in, std::string& line) {
  line.clear();
  for (int c = in.get(); c != std::istream::traits_type::eof() && line.size() < kMaxLine; c = in.get()) {
    if (c == '\n') return true;
    line.push_back(static_cast<char>(c));
  }
  return false;
}

}  // namespace

Result<std::unique_ptr<TakeReader>> TakeReader::open(const std::string& path) {
  std::error_code fault;
  if (!std::filesystem::is_regular_file(path, fault))
    return Error{fmt::format("{}: take not found; give the path of the file", printable(path))};
  auto in = std::make_unique<std::ifstream>(path, std::ios::binary);
  if (!*in) return Error{fmt::format("{}: it can't be read; check its permissions", printable(path))};
  return from_stream(std::move(in), path);
}

Result<std::unique_ptr<TakeReader>> TakeReader::from_stream(std::unique_ptr<std::istream> in, const std::string& name) {
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
  const bool complete = read_line(*in_, first) && read_line(*in_, second);
  // a file of another format may have no line ends
  if (!first.starts_with(std::string_view(kTakeMagic).substr(0, first.size())) || first.empty())
    return Error{"this is not a take of Limber"};
  if (!complete) return Error{"the take was cut off before it began; nothing of it can be played"};
  Result<TakeHeader> header = header_of(first, second);
  if (!header) return Error{header.error()};
  header_ = std::move(*header);
  position_ = first.size() + second.size() + 2;
  const std::optional<TakeFrame> kind = frame();
  if (!kind && damage_.empty()) return Error{"the take was cut off before it began; nothing of it can be played"};
  if (!kind) return Error{damage_};
  if (*kind != TakeFrame::begin || !read_initial_state(payload_, initial_state_))
    return Error{"the take's beginning is damaged; nothing of it can be played"};
  return {};
}

void TakeReader::set_damage(const std::string& description) {
  damage_ = fmt::format("damaged at byte {}: {}; the part before it is valid", position_, description);
}

bool TakeReader::read_bytes(std::size_t count, std::string& out) {
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
    if (shift >= 56) return set_damage("invalid length of a frame"), std::nullopt;
  }
  read += 1;
  // a frame that is truncated by the end of the file is no corruption
  if (length > size_ || position_ + read + length + 4 > size_) {
    const std::string_view kinds = "cfbte";
    if (kinds.find(static_cast<char>(first)) == kinds.npos) set_damage("invalid start of a frame");
    return {};
  }
  return FrameHead{first, length, read};
}

std::optional<TakeFrame> TakeReader::frame() {
  const std::optional<FrameHead> head = frame_head();
  if (!head) return {};
  std::string checksum;
  if (!read_bytes(static_cast<std::size_t>(head->length), payload_) || !read_bytes(4, checksum)) return {};
  const auto kind = static_cast<TakeFrame>(head->kind);
  if (TakeDecoder(checksum).fixed_int(4) != frame_checksum(kind, payload_))
    return set_damage("wrong checksum"), std::nullopt;
  position_ += head->bytes + head->length + 4;
  return kind;
}

bool TakeReader::next(RecordedPass& tick) {
  while (!at_end_) {
    const std::uint64_t before = position_;
    const std::optional<TakeFrame> kind = frame();
    if (kind && !decode_frame(*kind, tick)) {
      position_ = before;
      set_damage("invalid content of a frame");
    }
    at_end_ = !kind || end_ || !damage_.empty();
    if (!at_end_ && *kind == TakeFrame::tick) return true;
  }
  return false;
}

std::uint64_t TakeReader::count_ticks() {
  std::uint64_t count = 0;
  while (const std::optional<FrameHead> head = frame_head()) {
    const bool tick = static_cast<TakeFrame>(head->kind) == TakeFrame::tick && head->length > 0;
    if (tick && advances_time(static_cast<std::uint8_t>(in_->get()))) count++;
    in_->ignore(static_cast<std::streamsize>(head->length + 4 - (tick ? 1 : 0)));
    position_ += head->bytes + head->length + 4;
  }
  return count;
}

bool TakeReader::decode_frame(TakeFrame kind, RecordedPass& tick) {
  if (kind == TakeFrame::tick) {
    if (!read_pass(payload_, codec_, tick)) return false;
    for (const TakeSceneRun& run : tick.runs) {
      if (run.files > file_lists_.size()) return false;
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
    file_lists_.push_back(std::move(list));
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

std::shared_ptr<const script::Sources> TakeReader::sources(std::uint32_t files) {
  if (files == 0 || files > file_lists_.size()) return nullptr;
  sources_.resize(file_lists_.size());
  std::shared_ptr<const script::Sources>& sources = sources_[files - 1];
  if (sources != nullptr) return sources;
  const TakeFileList& list = file_lists_[files - 1];
  // runs with the same files share the sources and the models that were built from them
  for (std::size_t i = 0; i < sources_.size(); i++) {
    if (sources_[i] != nullptr && file_lists_[i] == list) return sources = sources_[i];
  }
  auto set = std::make_shared<model::FileSet>();
  set->mesh_paths = list.meshes;
  for (const auto& [path, content] : list.files) {
    if (content != 0) set->contents[path] = contents_[content - 1];
  }
  // a reload detects a changed model by its identity: share the library if no model and no mesh has changed
  TakeFileList models{{}, list.meshes, {}, false, "", ""};
  for (const auto& file : list.files) {
    if (!file.first.ends_with(".lua")) models.files.push_back(file);
  }
  std::shared_ptr<model::ModelLibrary>& library = libraries_[text_of(models)];
  if (library == nullptr) library = std::make_shared<model::ModelLibrary>(set);
  sources = std::make_shared<const script::Sources>(list.found, set, library);
  return sources;
}

std::optional<TakeReader::PresetBank> TakeReader::presets(std::uint32_t files) const {
  if (files == 0 || files > file_lists_.size() || !file_lists_[files - 1].has_presets) return {};
  PresetBank bank{{}, file_lists_[files - 1].preset_file};
  Result<ParsedPresets> read = parse_presets(file_lists_[files - 1].presets);
  if (read) bank.list = std::move(read->presets);
  return bank;
}

}  // namespace limber::engine
