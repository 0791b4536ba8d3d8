// Reads one block at a time; blocks are separated by empty lines.
#include "script/reference/annotation_reader.h"

#include <algorithm>
#include <array>

#include "base/check.h"
#include "base/text.h"
#include "sim/clock/beat_clock.h"
#include "sim/fixtures/fixture.h"
#include "sim/gears/gear.h"
#include "sim/mocap/mocap_source.h"
#include "sim/routes/route.h"
#include "sim/sensors/sensor.h"
#include "sim/shapes/shape.h"
#include "sim/tendons/tendon.h"
#include "sim/visuals/visuals.h"
#include "sim/world/body.h"
#include "sim/world/joint.h"
#include "sim/world/motor.h"
#include "sim/world/part.h"
#include "sim/world/world.h"

namespace limber::script {

namespace {

constexpr std::array<std::string_view, 4> kReferenceWords = {"---@page", "---@example", "---@see", "---@error"};

// the word in front of the first blank, which is removed from `text` together with the blank
std::string_view cut_word(std::string_view& text) {
  const std::size_t blank = text.find(' ');
  const std::string_view word = text.substr(0, blank);
  text.remove_prefix(blank == std::string_view::npos ? text.size() : blank + 1);
  return word;
}

void append_line(std::string& text, std::string_view line) {
  if (!text.empty()) text += '\n';
  text += line;
}

// "TYPE # words"; types contain no " # "
AnnotatedValue read_value(std::string_view name, std::string_view rest) {
  AnnotatedValue value;
  value.optional = name.ends_with('?');
  if (value.optional) name.remove_suffix(1);
  value.name = name;
  const std::size_t words = rest.find(" # ");
  value.type = rest.substr(0, words);
  if (words != std::string_view::npos) value.text = rest.substr(words + 3);
  return value;
}

// Collects the lines of one block.
class BlockReader {
 public:
  void read(std::string_view line) {
    if (line.starts_with("---@")) {
      std::string_view rest = line.substr(4);
      const std::string_view word = cut_word(rest);
      annotation(word, rest);
    } else if (line.starts_with("---")) {
      append_line(block_.doc, line.substr(3));
    } else if (line.starts_with("function ")) {
      function(line.substr(9));
    } else if (!line.starts_with("--")) {
      variable(line);
    }
  }

  bool is_page() const { return !page_.empty(); }
  bool is_block() const { return !block_.name.empty(); }
  std::string_view page() const { return page_; }
  AnnotatedBlock& block() { return block_; }

 private:
  void annotation(std::string_view word, std::string_view rest) {
    if (word == "page") {
      page_ = rest;
    } else if (word == "class") {
      const std::size_t colon = rest.find(": ");
      block_.name = rest.substr(0, colon);
      if (colon != std::string_view::npos) block_.base = rest.substr(colon + 2);
    } else if (word == "alias") {
      block_.kind = AnnotatedBlock::Kind::alias;
      block_.name = cut_word(rest);
      block_.base = rest;
    } else if (word == "type") {
      block_.kind = AnnotatedBlock::Kind::variable;
      block_.base = rest;
    } else if (word == "field" || word == "param") {
      const std::string_view name = cut_word(rest);
      block_.values.push_back(read_value(name, rest));
    } else if (word == "return") {
      block_.results.push_back(read_value({}, rest));
    } else if (word == "operator") {
      block_.operators.emplace_back(rest);
    } else {
      note(word, rest);
    }
  }

  void note(std::string_view word, std::string_view rest) {
    if (word == "properties") {
      block_.properties = &annotated_class(rest);
    } else if (word == "opts") {
      block_.options = &annotated_class(rest);
    } else if (word == "action") {
      const PropertyTable& table = annotated_class(cut_word(rest));
      append_line(block_.doc, table.at(rest).doc);
    } else if (word == "example") {
      block_.examples.emplace_back(rest);
    } else if (word == "see") {
      for (const std::string_view name : split(rest, ',')) block_.see.emplace_back(name.substr(name.starts_with(' ')));
    } else if (word == "error") {
      const std::size_t arrow = rest.find(" --> ");
      LIMBER_CHECK(arrow != std::string_view::npos);
      block_.errors.push_back({std::string(rest.substr(0, arrow)), std::string(rest.substr(arrow + 5))});
    }
  }

  // "body_:add_part(name, shape, opts) end"
  void function(std::string_view line) {
    const std::string_view name = line.substr(0, line.find('('));
    const std::size_t separator = name.find_first_of(".:");
    block_.kind = AnnotatedBlock::Kind::function;
    block_.name = name;
    if (separator == std::string_view::npos) return;
    block_.owner = shown_name(name.substr(0, separator));
    block_.name = block_.owner + std::string(name.substr(separator));
  }

  // "sim = {}" after a class is the variable of that name
  void variable(std::string_view line) {
    if (block_.kind == AnnotatedBlock::Kind::variable) block_.name = line.substr(0, line.find(" = "));
  }

  std::string page_;
  AnnotatedBlock block_;
};

// "FILE Title: one sentence."
AnnotatedPage& open_page(std::vector<AnnotatedPage>& pages, BlockReader& reader) {
  std::string_view rest = reader.page();
  const std::string_view file = cut_word(rest);
  const auto found = std::ranges::find(pages, file, &AnnotatedPage::file);
  if (found != pages.end()) return *found;
  const std::size_t colon = rest.find(": ");
  LIMBER_CHECK(colon != std::string_view::npos);
  AnnotatedPage page;
  page.file = file;
  page.title = rest.substr(0, colon);
  page.about = rest.substr(colon == std::string_view::npos ? 0 : colon + 2);
  page.introduction = reader.block().doc;
  page.notes = reader.block();
  return pages.emplace_back(std::move(page));
}

}  // namespace

const PropertyTable& annotated_class(std::string_view name) {
  const std::array<const PropertyTable*, 20> classes = {
      &sim::World::table(),       &sim::Body::table(),       &sim::Part::table(),    &sim::Joint::table(),
      &sim::Motor::table(),       &sim::Shape::table(),      &sim::Visuals::table(), &sim::Camera::table(),
      &sim::Appearance::table(),  &sim::Gear::table(),       &sim::imu_table(),      &sim::range_finder_table(),
      &sim::zone_table(),         &sim::touch_table(),       &sim::Tendon::table(),  &sim::Fixture::table(),
      &sim::MocapSource::table(), &sim::MocapJoint::table(), &sim::Route::table(),   &sim::BeatClock::table()};
  for (const PropertyTable* table : classes) {
    if (table->name() == name) return *table;
  }
  LIMBER_CHECK(!"a class that scripts see");
  return sim::World::table();
}

std::string shown_name(std::string_view variable) {
  if (variable.ends_with('_')) variable.remove_suffix(1);
  return std::string(variable == "behavior_self" ? "self" : variable);
}

bool is_reference_line(std::string_view line) {
  return std::ranges::find(kReferenceWords, line.substr(0, line.find(' '))) != kReferenceWords.end();
}

std::vector<AnnotatedPage> annotated_pages(std::span<const EmbeddedFile> annotations) {
  std::vector<AnnotatedPage> pages;
  std::string current;  // file of the page
  const auto finish = [&](BlockReader& reader) {
    if (reader.is_page()) current = open_page(pages, reader).file;
    if (!reader.is_block()) return;
    const auto page = std::ranges::find(pages, current, &AnnotatedPage::file);
    LIMBER_CHECK(page != pages.end());
    if (page != pages.end()) page->blocks.push_back(std::move(reader.block()));
  };
  for (const EmbeddedFile& file : annotations) {
    BlockReader reader;
    for (const std::string_view line : split(file.text, '\n')) {
      if (!line.empty()) {
        reader.read(line);
        continue;
      }
      finish(reader);
      reader = {};
    }
    finish(reader);
  }
  return pages;
}

}  // namespace limber::script
