// Converts the XML to elements that remember their file and line, and replaces <include> by the included elements.
#include "model/mjcf/document.h"

#include <algorithm>
#include <filesystem>

#include <fmt/format.h>

#include "base/hash.h"
#include "base/text.h"
#include "model/xml_document.h"
#include "model/xml_text.h"

namespace limber::model {

namespace {

constexpr int kMaxIncludeDepth = 16;
constexpr std::size_t kMaxTotalBytes = 64u << 20;

bool is_root(std::string_view name) { return name == "mujoco" || name == "mujocoinclude"; }

class DocumentReader {
 public:
  DocumentReader(const std::string& path, const MeshLibrary& files, Problems& problems)
      : folder_(std::filesystem::path(path).parent_path()), files_(files), problems_(problems) {
    document_.sources.push_back({path, 0, 0});
  }

  Result<MjcfDocument> run(std::string_view bytes) {
    document_.sources[0].hash = hash_bytes(bytes);
    total_bytes_ = bytes.size();
    const Result<void> read = read_file(bytes, 0, problems_, document_.root, 0);
    if (!read) return Error{read.error()};
    if (elements_ > kMaxMjcfElements) {
      problems_.error(1, fmt::format("more than {} elements; the rest is ignored", kMaxMjcfElements),
                      "Split or simplify the file.");
    }
    return std::move(document_);
  }

 private:
  // Parses one file; its root becomes `out`.
  Result<void> read_file(std::string_view bytes, int source, Problems& problems, MjcfElement& out, int depth) {
    Result<std::string> text = clean_xml_text(bytes, kMjcfFormat, problems);
    if (!text) return Error{"1: " + text.error()};
    tinyxml2::XMLDocument xml;
    if (Result<void> parsed = parse_xml(*text, xml); !parsed) return parsed;
    const tinyxml2::XMLElement* root = xml.RootElement();
    if (root == nullptr) return Error{"1: <mujoco> element not found. Give an MJCF file."};
    if (!is_root(root->Name())) {
      return Error{fmt::format("{}: the root element is <{}>, not <mujoco>. An MJCF file starts with <mujoco>.",
                               root->GetLineNum(), printable(root->Name()))};
    }
    convert(*root, source, out, depth);
    return {};
  }

  void convert(const tinyxml2::XMLElement& from, int source, MjcfElement& to, int depth) {
    to.name = from.Name();
    to.line = from.GetLineNum();
    to.source = source;
    for (const tinyxml2::XMLAttribute* a = from.FirstAttribute(); a != nullptr; a = a->Next())
      to.attributes.emplace_back(a->Name(), a->Value());
    for (const tinyxml2::XMLElement* e = from.FirstChildElement(); e != nullptr; e = e->NextSiblingElement()) {
      if (++elements_ > kMaxMjcfElements) return;
      MjcfElement child;
      if (std::string_view(e->Name()) == "include") {
        include(*e, source, to, depth);
        continue;
      }
      convert(*e, source, child, depth);
      to.children.push_back(std::move(child));
    }
  }

  void include(const tinyxml2::XMLElement& element, int source, MjcfElement& parent, int depth) {
    const int own_line = element.GetLineNum();
    const int line = source == 0 ? own_line : document_.sources[static_cast<std::size_t>(source)].line;
    const char* const file = element.Attribute("file");
    if (file == nullptr || *file == '\0') {
      problems_.error(line, "<include> names no file; ignored", "Write <include file=\"…\"/>.");
      return;
    }
    const auto reject = [&](const std::string& reason, const std::string& fix) {
      problems_.error(line, fmt::format("<include file='{}'> ignored: {}", printable(file), reason), fix);
    };
    if (depth >= kMaxIncludeDepth) return reject("includes are nested too deep", "Remove the cycle.");
    if (static_cast<int>(document_.sources.size()) > kMaxMjcfIncludes)
      return reject(fmt::format("more than {} files", kMaxMjcfIncludes), "Merge the files.");
    const std::string path = (folder_ / file).lexically_normal().string();
    const auto same = [&](const MjcfSource& s) { return s.path == path; };
    if (std::any_of(document_.sources.begin(), document_.sources.end(), same))
      return reject("the file was read already", "Include each file once.");
    const int index = static_cast<int>(document_.sources.size());
    document_.sources.push_back({path, 0, line});
    const Result<std::string> bytes = files_.read(path, kMaxUrdfBytes);
    if (!bytes)
      return reject(bytes.error().substr(0, bytes.error().find(". ")),
                    "Correct the path; it is relative to the folder of the model's file.");
    total_bytes_ += bytes->size();
    if (total_bytes_ > kMaxTotalBytes)
      return reject(fmt::format("all files together have more than {} bytes", kMaxTotalBytes), "Simplify the model.");
    document_.sources[static_cast<std::size_t>(index)].hash = hash_bytes(*bytes);
    Problems found;
    MjcfElement root;
    const Result<void> read = read_file(*bytes, index, found, root, depth + 1);
    for (const Problem& p : found.release()) {
      const std::string text = fmt::format("{} line {}: {}", printable(file), p.line, p.text);
      if (p.severity == Severity::note) {
        problems_.note(line, text, p.fix);
      } else {
        problems_.error(line, text, p.fix);
      }
    }
    if (!read) return reject("line " + read.error(), "Correct the included file.");
    for (MjcfElement& child : root.children) parent.children.push_back(std::move(child));
  }

  std::filesystem::path folder_;
  const MeshLibrary& files_;
  Problems& problems_;
  MjcfDocument document_;
  std::size_t total_bytes_ = 0;
  int elements_ = 0;
};

}  // namespace

const std::string* MjcfElement::attribute(std::string_view attribute_name) const {
  const auto found = std::find_if(attributes.begin(), attributes.end(),
                                  [&](const auto& attribute) { return attribute.first == attribute_name; });
  return found == attributes.end() ? nullptr : &found->second;
}

Result<MjcfDocument> read_mjcf(std::string_view bytes, const std::string& path, const MeshLibrary& files,
                               Problems& problems) {
  return DocumentReader(path, files, problems).run(bytes);
}

}  // namespace limber::model
