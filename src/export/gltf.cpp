// Collects keyframes and writes the files at the end. A .glb file is a header, the JSON text and the binary buffer.
#include "export/writers.h"

#include <bit>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "base/text.h"
#include "export/atomic_file.h"
#include "export/gltf_model.h"
#include "export/names.h"

namespace limber::exporter {

namespace {

constexpr std::uint32_t kMagic = 0x46546C67;        // "glTF"
constexpr std::uint32_t kJsonChunk = 0x4E4F534A;    // "JSON"
constexpr std::uint32_t kBinaryChunk = 0x004E4942;  // "BIN"

static_assert(std::endian::native == std::endian::little, "glTF's numbers are written as they lie in memory");

std::string little_endian_words(std::initializer_list<std::uint64_t> numbers) {
  std::string out;
  for (const std::uint64_t number : numbers) {
    for (unsigned shift = 0; shift < 32; shift += 8) out.push_back(static_cast<char>(number >> shift & 0xffu));
  }
  return out;
}

Result<void> write_all(AtomicFile& file, const std::vector<std::string_view>& pieces) {
  for (const std::string_view piece : pieces) {
    if (Result<void> written = file.write(piece); !written) return written;
  }
  return {};
}

class GltfWriter : public MotionWriter {
 public:
  GltfWriter(std::string path, std::uint64_t max_bytes)
      : path_(std::move(path)),
        max_bytes_(max_bytes),
        file_(path_),
        bin_(std::filesystem::path(path_).replace_extension(".bin").string()) {}

  Result<void> begin() {
    if (Result<void> opened = file_.open(); !opened || is_glb()) return opened;
    return bin_.open();
  }

  Result<void> add_body(const MotionBody& body) override {
    tracks_.add_body(body);
    return {};
  }

  Result<void> add_frame(double time, std::span<const MotionSample> bodies) override {
    tracks_.add_frame(time, bodies);
    if (tracks_.bytes() <= max_bytes_) return {};
    return Error{fmt::format(
        "{}: the keys of {} frames take {} MB, more than most programs read. Choose bodies with --body, fewer "
        "frames with --rate, or a range with --from and --to",
        printable(path_), tracks_.times().size(), tracks_.bytes() >> 20u)};
  }

  Result<void> finish() override {
    const std::filesystem::path path(path_);
    const std::string uri = is_glb() ? "" : percent_encode(std::filesystem::path(bin_.path()).filename().string());
    Result<GltfModel> model = gltf_model(tracks_, printable(path.stem().string()), uri);
    if (!model) return Error{fmt::format("{}: {}", printable(path_), model.error())};
    return is_glb() ? finish_glb(*model) : finish_gltf(*model);
  }

 private:
  bool is_glb() const { return path_.ends_with(".glb"); }

  Result<void> finish_gltf(const GltfModel& model) {
    if (Result<void> written = write_all(bin_, model.pieces); !written) return written;
    if (Result<void> written = file_.write(model.json); !written) return written;
    if (model.bytes > 0) {
      if (Result<void> finished = bin_.finish(); !finished) return finished;
    }
    return file_.finish();
  }

  Result<void> finish_glb(GltfModel& model) {
    model.json.resize((model.json.size() + 3) / 4 * 4, ' ');
    const bool has_bytes = model.bytes > 0;
    const std::uint64_t total_bytes = 12 + 8 + model.json.size() + (has_bytes ? 8 + model.bytes : 0);
    const std::string header = little_endian_words({kMagic, 2, total_bytes, model.json.size(), kJsonChunk});
    if (Result<void> written = write_all(file_, {header, model.json}); !written) return written;
    if (has_bytes) {
      if (Result<void> written = file_.write(little_endian_words({model.bytes, kBinaryChunk})); !written)
        return written;
      if (Result<void> written = write_all(file_, model.pieces); !written) return written;
    }
    return file_.finish();
  }

  std::string path_;
  std::uint64_t max_bytes_;
  AtomicFile file_;
  AtomicFile bin_;  // beside a .gltf
  GltfTracks tracks_;
};

}  // namespace

Result<std::unique_ptr<MotionWriter>> make_gltf_writer(const std::string& path, std::uint64_t max_bytes) {
  auto writer = std::make_unique<GltfWriter>(path, max_bytes);
  if (const Result<void> begun = writer->begin(); !begun) return Error{begun.error()};
  return std::unique_ptr<MotionWriter>(std::move(writer));
}

}  // namespace limber::exporter
