// The format of cue files, and the errors in them.
#include <fstream>

#include <gtest/gtest.h>

#include "engine/cues/cue_edit.h"
#include "engine/cues/cue_list.h"

namespace limber::engine::test {
namespace {

std::string with_cue(const std::string& fields) {
  return "{\"limber cues\": 1, \"cues\": [{\"name\": \"first\"}, {" + fields + "}]}";
}

std::string fault_of(const std::string& text) {
  const Result<CueList> cues = parse_cues(text);
  return cues ? "" : cues.error();
}

TEST(CueFile, ReadsEveryField) {
  const Result<CueList> cues = parse_cues(with_cue(
      R"("name": "storm", "preset": "dark", "time": 2.5, "easing": "in", "follow": 0, "note": "bring the fog", "at": "bar", "when": "/drum",
         "messages": [["/lighting/blackout", true], ["/mocap/play", "dancer", 1, null]])"));
  ASSERT_TRUE(cues.ok()) << cues.error();
  ASSERT_EQ(cues->size(), 2u);
  const Cue& first = (*cues)[0];
  EXPECT_EQ(first.preset, "");
  EXPECT_FALSE(first.follow.has_value());
  EXPECT_TRUE(messages_of(first).empty());
  const Cue& cue = (*cues)[1];
  EXPECT_EQ(cue.note, "bring the fog");
  EXPECT_EQ(cue.follow, 0.0);
  EXPECT_EQ(cue.at, CueStart::bar);
  EXPECT_EQ(cue.when, "/drum");
  EXPECT_EQ(first.at, CueStart::now);
  const std::vector<Message> messages = messages_of(cue);
  ASSERT_EQ(messages.size(), 3u);
  EXPECT_EQ(messages[0].address, "/preset/recall");
  ASSERT_EQ(messages[0].args.size(), 3u);
  EXPECT_EQ(messages[0].args[0].text, "dark");
  EXPECT_EQ(messages[0].args[1].number, 2.5);
  EXPECT_EQ(messages[0].args[2].text, "in");
  EXPECT_EQ(messages[1].args[0].kind, Arg::Kind::boolean);
  ASSERT_EQ(messages[2].args.size(), 3u);
  EXPECT_EQ(messages[2].args[0].text, "dancer");
  EXPECT_EQ(messages[2].args[2].kind, Arg::Kind::nil);
}

TEST(CueFile, AnEmptyFileHasNoCues) {
  const Result<CueList> cues = parse_cues(" \n");
  ASSERT_TRUE(cues.ok());
  EXPECT_TRUE(cues->empty());
}

TEST(CueFile, ErrorsNameTheCueAndTheField) {
  const std::pair<const char*, const char*> cases[] = {
      {R"("name": "")", "cue 2 '': name: "},
      {R"("preset": "a")", "cue 2: name: "},
      {R"("name": "first")", "cue 2 'first': name: another cue has the same name"},
      {R"("name": "b", "preset": 3)", "cue 2 'b': preset: must be a text"},
      {R"("name": "b", "time": -1)", "cue 2 'b': time: must be a number of seconds from 0 to 86400"},
      {R"("name": "b", "time": "long")", "cue 2 'b': time: must be a number"},
      {R"("name": "b", "easing": "quick")", "cue 2 'b': easing: unknown easing 'quick'; expected one of: linear"},
      {R"("name": "b", "follow": 1e9)", "cue 2 'b': follow: must be"},
      {R"("name": "b", "folow": 1)", "cue 2 'b': there is no field 'folow'; did you mean 'follow'?"},
      {R"("name": "b", "at": "noon")", "cue 2 'b': at: must be \"now\", \"beat\" or \"bar\", not 'noon'"},
      {R"("name": "b", "begin": 1)", "cue 2 'b': begin: only the first cue has it"},
      {R"("name": "b", "when": "drum")", "cue 2 'b': when: 'drum' is not an address"},
      {R"("name": "b", "when": "/cue/go")", "cue 2 'b': when: a cue can't control the cue list"},
      {R"("name": "b", "messages": "/x")", "cue 2 'b': messages: must be a list"},
      {R"("name": "b", "messages": [["/a"], "/b"])", "cue 2 'b': messages: 2: must be a list of an address"},
      {R"("name": "b", "messages": [["a"]])", "cue 2 'b': messages: 1: 'a' is not an address"},
      {R"("name": "b", "messages": [["/a", [1]]])", "cue 2 'b': messages: 1: value 1 must be a number"},
      {R"("name": "b", "messages": [["/Cue/go"]])", "cue 2 'b': messages: 1: a cue can't control the cue list"},
  };
  for (const auto& [fields, error] : cases) {
    const std::string fault = fault_of(with_cue(fields));
    EXPECT_TRUE(fault.starts_with(error)) << fields << ": " << fault;
  }
}

TEST(CueFile, ErrorsOfTheFile) {
  EXPECT_TRUE(fault_of("{\n\"limber cues\": 1\n\"cues\": []}").starts_with("line 3: not valid JSON"));
  EXPECT_TRUE(fault_of("[]").starts_with("not a cue file; expected"));
  EXPECT_TRUE(fault_of("{\"limber presets\": 1, \"cues\": []}").starts_with("not a cue file"));
  EXPECT_TRUE(fault_of("{\"limber cues\": 2, \"cues\": []}").starts_with("it was written by a newer version"));
  EXPECT_EQ(fault_of("{\"limber cues\": 1, \"cues\": [3]}"),
            "cue 1: must be an object, such as {\"name\": \"opening\"}");
  EXPECT_NE(fault_of(std::string(100, '[') + std::string(100, ']')), "");
  EXPECT_NE(fault_of("{\"limber cues\": 1, \"cues\": [{\"name\": \"a\", \"time\": 1e999}]}"), "");
}

TEST(CueFile, TheExampleOfTheManualIsValid) {
  std::ifstream in(LIMBER_SOURCE_DIR "/docs/howto/cues.md");
  const std::string page{std::istreambuf_iterator<char>(in), {}};
  const std::string fence = "```json\n";
  const std::size_t begin = page.find(fence);
  ASSERT_NE(begin, page.npos);
  const std::string block = page.substr(begin + fence.size(), page.find("\n```", begin) - begin - fence.size());
  const Result<CueList> cues = parse_cues(block);
  ASSERT_TRUE(cues.ok()) << cues.error();
  EXPECT_EQ(cues->size(), 4u);
}

TEST(CueFile, IsBounded) {
  std::string many;
  for (std::size_t i = 0; i <= kMaxCues; i++)
    many += (i == 0 ? "" : ",") + ("{\"name\": \"" + std::to_string(i) + "\"}");
  EXPECT_EQ(fault_of("{\"limber cues\": 1, \"cues\": [" + many + "]}"), "at most 1000 cues");
  std::string messages;
  for (std::size_t i = 0; i <= Cue::kMaxMessages; i++) messages += i == 0 ? "[\"/a\"]" : ",[\"/a\"]";
  EXPECT_TRUE(fault_of(with_cue("\"name\": \"b\", \"messages\": [" + messages + "]"))
                  .starts_with("cue 2 'b': messages: at most 256 in a cue"));
}

std::string edited(const std::string& text, const std::string& address, std::vector<Arg> args,
                   std::size_t current = 0) {
  const Result<std::string> result = edited_cues(text, {address, std::move(args)}, current);
  return result ? *result : "error: " + result.error();
}

TEST(CueEdit, AddsMovesAndRemoves) {
  std::string text = edited("", "/cue/add", {Arg::of("one")});
  EXPECT_EQ(text, "{\n  \"limber cues\": 1,\n  \"cues\": [\n    { \"name\": \"one\" }\n  ]\n}\n");
  text = edited(text, "/Cue/Add", {Arg::of("three"), Arg::of("look")}, 1);
  text = edited(text, "/cue/add", {Arg::of("two")}, 1);
  const auto names = [](const std::string& file) {
    std::string list;
    const CueList cues = parse_cues(file).value();
    for (const Cue& cue : cues) list += cue.name + " ";
    return list;
  };
  EXPECT_EQ(names(text), "one two three ");
  EXPECT_EQ(parse_cues(text).value()[2].preset, "look");
  EXPECT_EQ(names(edited(text, "/cue/move", {Arg::of("three"), Arg::of(1.0)})), "three one two ");
  EXPECT_EQ(names(edited(text, "/cue/move", {Arg::of(1.0), Arg::of(3.0)})), "two three one ");
  EXPECT_EQ(names(edited(text, "/cue/remove", {Arg::of("two")})), "one three ");
  EXPECT_EQ(names(edited(text, "/cue/remove", {Arg::of(3.0)})), "one two ");
}

TEST(CueEdit, SetsFieldsAndKeepsTheOthers) {
  const std::string before = R"({"limber cues": 1, "cues": [
    {"name": "a", "note": "first", "messages": [["/x", 1, "two", null, true]], "time": 2.5},
    {"name": "b"}]})";
  const auto set = [&](const char* field, Arg value) {
    return edited(before, "/cue/set", {Arg::of("a"), Arg::of(field), std::move(value)});
  };
  EXPECT_EQ(set("time", Arg::of(4.0)),
            "{\n  \"limber cues\": 1,\n  \"cues\": [\n    { \"name\": \"a\", \"note\": \"first\", \"messages\": "
            "[[\"/x\",1,\"two\",null,true]], \"time\": 4 },\n    { \"name\": \"b\" }\n  ]\n}\n");
  EXPECT_EQ(parse_cues(set("follow", Arg::of(1.5))).value()[0].follow, 1.5);
  EXPECT_EQ(parse_cues(set("at", Arg::of("bar"))).value()[0].at, CueStart::bar);
  EXPECT_EQ(parse_cues(set("note", Arg::of(""))).value()[0].note, "");
  EXPECT_EQ(parse_cues(set("name", Arg::of("c"))).value()[0].name, "c");
  EXPECT_EQ(set("time", Arg::of("long")), "error: cue 1 'a': time: must be a number of seconds from 0 to 86400");
  EXPECT_EQ(set("name", Arg::of("b")), "error: cue 2 'b': name: another cue has the same name");
  EXPECT_EQ(set("tme", Arg::of(1.0)), "error: cue 1 'a': there is no field 'tme'; did you mean 'time'?");
  EXPECT_EQ(set("messages", Arg::of("/x")), "error: messages are edited in the file");
}

TEST(CueEdit, RejectsWrongRequestsAndFiles) {
  const std::string file = "{\"limber cues\": 1, \"cues\": [{\"name\": \"one\"}]}";
  EXPECT_EQ(edited(file, "/cue/remove", {Arg::of("on")}), "error: there is no cue 'on'; did you mean 'one'?");
  EXPECT_EQ(edited(file, "/cue/remove", {Arg::of(2.0)}), "error: the number of a cue must be 1 to 1, got 2");
  EXPECT_EQ(edited(file, "/cue/remove", {}), "error: takes the name or the number of a cue");
  EXPECT_EQ(edited(file, "/cue/add", {Arg::of(3.0)}), "error: takes a name, and the name of a preset if it has one");
  EXPECT_EQ(edited(file, "/cue/add", {Arg::of("one")}), "error: cue 2 'one': name: another cue has the same name");
  EXPECT_EQ(edited(file, "/cue/move", {Arg::of("one")}), "error: takes a cue, and the number that it will have");
  EXPECT_EQ(edited("{", "/cue/add", {Arg::of("two")}).substr(0, 22), "error: line 1: not val");
}

}  // namespace
}  // namespace limber::engine::test
