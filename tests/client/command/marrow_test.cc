// The smaller subcommands of `marrow`, run as a person runs them.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/testing/subprocess.h"

namespace marrow {
namespace {

using nlohmann::json;
using testing::Finished;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using testing::ListFolder;
using testing::ProgramPath;
using testing::ReadFile;
using testing::RunProgram;
using testing::TemporaryFolder;
using testing::WriteFile;

Finished Marrow(std::vector<std::string> arguments) {
  arguments.insert(arguments.begin(), ProgramPath("marrow"));
  return RunProgram(arguments);
}

constexpr char kTetrahedron[] =
    "OFF\n5 4 0\n0 0 0\n9 9 9\n1 0 0\n0 1 0\n0 0 1\n"
    "3 0 3 2\n3 0 2 4\n3 0 4 3\n3 2 3 4\n";

TEST(MarrowTest, HelpTeaches) {
  const Finished help = Marrow({"--help"});
  EXPECT_EQ(help.code, 0);
  for (const char* word :
       {"Examples:", "Exit codes:", "MARROW_SERVER", "130", "segment",
        "inspect", "spectrum", "sample", "health"}) {
    EXPECT_THAT(help.out, HasSubstr(word));
  }
  const Finished segment = Marrow({"segment", "--help"});
  for (const char* word : {"STEM.level-N.ply", "--kappa", "--tolerance",
                           "--threads", "--quantize"}) {
    EXPECT_THAT(segment.out, HasSubstr(word));
  }
}

TEST(MarrowTest, TellsItsVersion) {
  const Finished run = Marrow({"--version"});
  EXPECT_EQ(run.code, 0);
  EXPECT_THAT(run.out, ::testing::MatchesRegex("marrow [0-9.]+\n"));
  for (const char* command :
       {"segment", "cut", "inspect", "spectrum", "sample", "health"}) {
    const Finished alone = Marrow({command, "--version"});
    EXPECT_EQ(alone.code, 0) << command << alone.err;
    EXPECT_EQ(alone.out, run.out) << command;
    EXPECT_THAT(Marrow({command, "--help"}).out, HasSubstr("--version"));
  }
  EXPECT_EQ(Marrow({"segment", "none.off", "--version"}).out, run.out);
}

TEST(MarrowTest, ACommandLineThatMakesNoSenseIsAUsageError) {
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{{},
                                             {"segment"},
                                             {"frobnicate"},
                                             {"segment", "--frob", "x.off"},
                                             {"sample"},
                                             {"sample", "humanoid"},
                                             {"inspect"}}) {
    const Finished run = Marrow(arguments);
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, ::testing::MatchesRegex("marrow: [^\n]+--help\n"));
    EXPECT_THAT(run.out, IsEmpty());
  }
}

TEST(MarrowTest, ValuesThatAreNoneAreNamed) {
  const std::vector<std::array<const char*, 3>> cases = {
      {"--kappa", "", "--kappa: '' is no number"},
      {"--kappa", "abc", "--kappa: 'abc' is no number"},
      {"--pairs", "2.5", "--pairs: '2.5' is no whole number"},
      {"--pairs", "010", "--pairs: '010' is no whole number"},
      {"--levels", "-1", "--levels: '-1' is no whole number"},
      {"--threads", "17", "--threads: '17' is no number from 1 to 16"},
      {"--method", "PAPER", "--method: 'PAPER' is neither merge nor paper"},
      {"--method", "1", "--method: '1' is neither merge nor paper"},
      {"--closed", "3,x", "--closed: 'x' is no whole number"},
      {"--timeout", "nan", "--timeout: 'nan' is no number of seconds"},
      {"--timeout", "0", "--timeout: '0' is no number of seconds"},
      {"--quantize", "25",
       "--quantize: '25' is no number of bits from 1 to 24"}};
  for (const auto& [option, value, complaint] : cases) {
    const Finished run = Marrow({"segment", "x.off", option, value});
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr(complaint));
  }
  EXPECT_THAT(Marrow({"frobnicate"}).err, HasSubstr("'frobnicate'"));
  for (const char* command : {"segment", "cut", "inspect", "spectrum"}) {
    const Finished run = Marrow({command, ""});
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr("FILE: the name is empty"));
  }
}

TEST(MarrowTest, InspectReportsOnAMesh) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  const Finished person = Marrow({"inspect", folder / "t.off"});
  EXPECT_EQ(person.code, 0) << person.err;
  EXPECT_THAT(person.out, HasSubstr("components"));
  EXPECT_THAT(Marrow({"inspect", folder / "t.off", "-q"}).out, IsEmpty());
  const json result =
      json::parse(Marrow({"inspect", folder / "t.off", "--json"}).out);
  EXPECT_EQ(result["report"]["faces"], 4);
  EXPECT_EQ(result["report"]["vertices"], 4);
  EXPECT_EQ(result["report"]["euler_characteristic"], 2);
  EXPECT_EQ(result["report"]["genus"], 0);
  EXPECT_EQ(result["report"]["bodies"], 1);
  EXPECT_GT(result["report"]["predicted_bytes"], 0);
  ASSERT_EQ(result["report"]["findings"].size(), 1u);
  EXPECT_EQ(result["report"]["findings"][0]["code"], "UNUSED_POINTS");
  EXPECT_EQ(result["geometry_digest"].get<std::string>().size(), 64u);
}

TEST(MarrowTest, ADashIsStandardInputWhateverTheFolderHolds) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  const auto run = [&](const std::string& arguments) {
    return RunProgram({"/bin/sh", "-c",
                       "cd " + folder.path() + " && mkdir -p ./- && " +
                           ProgramPath("marrow") + " " + arguments});
  };
  const Finished inspect = run("inspect - --json < t.off");
  EXPECT_EQ(inspect.code, 0) << inspect.err;
  EXPECT_EQ(json::parse(inspect.out)["report"]["faces"], 4);
  EXPECT_EQ(run("segment - -o out < t.off").code, 0);
  EXPECT_THAT(ListFolder(folder / "out"), ::testing::Contains("stdin.seg"));
}

TEST(MarrowTest, ADashIsNoFolderForResults) {
  for (const char* command : {"segment", "cut"}) {
    const Finished run = Marrow({command, "x.off", "-o", "-"});
    EXPECT_EQ(run.code, 2);
    EXPECT_THAT(run.err, HasSubstr("name a folder"));
  }
}

TEST(MarrowTest, InspectTellsWhyThereIsNoGenus) {
  const TemporaryFolder folder;
  const auto inspect = [&](const std::string& text) {
    WriteFile(folder / "t.off", text);
    return Marrow({"inspect", folder / "t.off"}).out;
  };
  EXPECT_THAT(inspect("OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n"),
              HasSubstr("none: the surface is open"));
  // The projective plane.
  EXPECT_THAT(inspect("OFF\n6 10 0\n0 0 0\n4 0 1\n0 5 2\n0 1 6\n3 4 5\n7 2 3\n"
                      "3 0 1 2\n3 0 2 3\n3 0 3 4\n3 0 4 5\n3 0 5 1\n"
                      "3 1 2 4\n3 2 3 5\n3 3 4 1\n3 4 5 2\n3 5 1 3\n"),
              HasSubstr("none: the surface has one side"));
}

TEST(MarrowTest, InspectTellsWhatWillBeDone) {
  const TemporaryFolder folder;
  // Two triangles turned against each other, with a point to spare.
  WriteFile(folder / "t.off",
            "OFF\n5 2 0\n0 0 0\n1 0 0\n0 1 0\n1 1 0\n9 9 9\n"
            "3 0 1 2\n3 1 2 3\n");
  const Finished person = Marrow({"inspect", folder / "t.off"});
  EXPECT_THAT(person.out, HasSubstr("1 face is turned against"));
  EXPECT_THAT(person.out, HasSubstr("1 hole or open border"));
  const json report = json::parse(
      Marrow({"inspect", folder / "t.off", "--json"}).out)["report"];
  EXPECT_EQ(report["flipped_faces"], 1);
  EXPECT_TRUE(report["genus"].is_null());
  std::vector<std::string> codes;
  for (const json& finding : report["findings"])
    codes.push_back(finding["code"]);
  EXPECT_THAT(codes, ::testing::ElementsAre("WELDED_POINTS", "FLIPPED_FACES",
                                            "BOUNDARIES", "UNUSED_POINTS"));
}

// So many of them that no payload could hold them, and some nowhere.
TEST(MarrowTest, CountsVerticesOfNoFaceHoweverMany) {
  const TemporaryFolder folder;
  std::string text = "OFF\n100004 4 0\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n";
  for (int i = 0; i < 50'000; ++i) text += "1e30 nan inf\n7 7 7\n";
  WriteFile(folder / "t.off", text + "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
  for (const char* command : {"inspect", "spectrum"}) {
    const Finished run =
        Marrow({command, folder / "t.off", "--json", "--quantize", "12"});
    ASSERT_EQ(run.code, 0) << run.err;
    const json report = json::parse(run.out)["report"];
    EXPECT_EQ(report["unused_points"], 100'000) << command;
    ASSERT_EQ(report["findings"].size(), 1u) << command;
    EXPECT_EQ(report["findings"][0]["code"], "UNUSED_POINTS");
    EXPECT_EQ(report["findings"][0]["count"], 100'000);
  }
  EXPECT_THAT(Marrow({"inspect", folder / "t.off"}).out,
              HasSubstr("100000 vertices are in no face"));
}

TEST(MarrowTest, InspectTellsWhatIsWrong) {
  const TemporaryFolder folder;
  WriteFile(folder / "nan.off", "OFF\n3 1 0\n0 0 0\nnan 0 0\n0 1 0\n3 0 1 2\n");
  WriteFile(folder / "text.off", "hello\n");
  WriteFile(folder / "x.drc", "DRACOgarbage");
  WriteFile(folder / "points.off", "OFF\n1 0 0\n0 0 0\n");
  for (const char* name :
       {"nan.off", "text.off", "x.drc", "points.off", "none.off"}) {
    const Finished run = Marrow({"inspect", folder / name});
    EXPECT_EQ(run.code, 1) << name;
    EXPECT_THAT(run.err, HasSubstr(folder / name));
    EXPECT_THAT(run.out, IsEmpty());
  }
  const Finished as_json = Marrow({"inspect", folder / "nan.off", "--json"});
  const json error = json::parse(as_json.out);
  EXPECT_EQ(error["event"], "error");
  EXPECT_EQ(error["reason"], "MESH_REJECTED");
}

TEST(MarrowTest, SpectrumPrintsEigenvaluesAscending) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  const Finished run = Marrow({"spectrum", folder / "t.off", "-k", "2"});
  EXPECT_EQ(run.code, 0) << run.err;
  std::istringstream lines(run.out);
  std::vector<double> values;
  for (double value; lines >> value;) values.push_back(value);
  ASSERT_EQ(values.size(), 3u);
  EXPECT_NEAR(values[0], 0, 1e-9);
  EXPECT_GT(values[1], 0);
  EXPECT_TRUE(std::is_sorted(values.begin(), values.end()));
  const json result = json::parse(
      Marrow({"spectrum", folder / "t.off", "-k", "2", "--json"}).out);
  EXPECT_EQ(result["eigenvalues"].get<std::vector<double>>(), values);
}

TEST(MarrowTest, SpectrumOfManyPiecesIsWarnedOf) {
  const TemporaryFolder folder;
  std::string points, faces;
  for (int i = 0; i < 4; ++i) {
    const std::string x = std::to_string(5 * i);
    points += x + " 0 0\n" + x + " 1 0\n" + x + " 0 1\n";
    faces += "3 " + std::to_string(3 * i) + " " + std::to_string(3 * i + 1) +
             " " + std::to_string(3 * i + 2) + "\n";
  }
  WriteFile(folder / "four.off", "OFF\n12 4 0\n" + points + faces);
  const Finished few = Marrow({"spectrum", folder / "four.off", "-k", "3"});
  EXPECT_EQ(few.out, "0\n0\n0\n0\n");
  EXPECT_THAT(few.err, HasSubstr("all eigenvalues are 0"));
  const Finished quiet =
      Marrow({"spectrum", folder / "four.off", "-k", "3", "--quiet"});
  EXPECT_EQ(quiet.err, "");
  const Finished more = Marrow({"spectrum", folder / "four.off", "-k", "4"});
  EXPECT_EQ(more.err, "");
}

// Five vertices in the file, of which the second has no face.
TEST(MarrowTest, SpectrumWritesEigenvectorsInTheFilesOrder) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  ASSERT_EQ(
      Marrow({"spectrum", folder / "t.off", "-k", "2", "-o", folder / "v.npy"})
          .code,
      0);
  const std::string npy = ReadFile(folder / "v.npy");
  ASSERT_EQ(npy.substr(0, 6), "\x93NUMPY");
  EXPECT_THAT(npy, HasSubstr("'shape': (5, 3)"));
  const size_t begin = npy.find('\n') + 1;
  ASSERT_EQ(begin % 64, 0u);
  ASSERT_EQ(npy.size() - begin, 15 * sizeof(double));
  std::vector<double> values(15);
  std::copy_n(npy.data() + begin, npy.size() - begin,
              reinterpret_cast<char*>(values.data()));
  // The constant eigenvector: 1 over the root of the area.
  const double area = 1.5 + std::sqrt(3.0) / 2;
  for (size_t vertex : {0, 2, 3, 4}) {
    EXPECT_NEAR(std::abs(values[vertex]), 1 / std::sqrt(area), 1e-9);
  }
  EXPECT_TRUE(std::isnan(values[1]));
}

TEST(MarrowTest, SpectrumRefusesAnOutputOfNoFormat) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  const Finished run =
      Marrow({"spectrum", folder / "t.off", "-o", folder / "v.txt"});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("neither .npz nor .npy"));
  EXPECT_FALSE(std::filesystem::exists(folder / "v.txt"));
}

// Before there is anything to write: the mesh is missing too.
TEST(MarrowTest, SpectrumLooksAtItsOutputFirst) {
  const TemporaryFolder folder;
  const Finished run =
      Marrow({"spectrum", folder / "none.off", "-o", folder / "no/such/v.npz"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("create its folder first"));
}

TEST(MarrowTest, SpectrumRefusesImpossibleNumbers) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  const Finished run = Marrow({"spectrum", folder / "t.off", "-k", "0"});
  EXPECT_EQ(run.code, 2);
  EXPECT_THAT(run.err, HasSubstr("--pairs"));
}

TEST(MarrowTest, SamplesAreListedAndMade) {
  const Finished list = Marrow({"sample", "--list"});
  EXPECT_EQ(list.code, 0);
  for (const char* name : {"humanoid", "quadruped", "hand", "octopus"}) {
    EXPECT_THAT(list.out, HasSubstr(name));
  }
  const TemporaryFolder folder;
  const Finished made =
      Marrow({"sample", "hand", "--pose", "grasp", "--faces", "5000", "-o",
              folder / "hand.ply", "--parts", folder / "hand.seg"});
  EXPECT_EQ(made.code, 0) << made.err;
  const std::string parts = ReadFile(folder / "hand.seg");
  EXPECT_EQ(std::count(parts.begin(), parts.end(), '\n'), 5000);
  EXPECT_THAT(made.out, HasSubstr("thumb"));
  const Finished quiet =
      Marrow({"sample", "hand", "-q", "-o", folder / "again.ply", "--parts",
              folder / "again.seg"});
  EXPECT_EQ(quiet.code, 0) << quiet.err;
  EXPECT_EQ(quiet.out + quiet.err, "");
}

TEST(MarrowTest, ImpossibleSamplesAreUsageErrors) {
  const TemporaryFolder folder;
  const std::string out = folder / "x.off";
  for (const std::vector<std::string>& arguments :
       std::vector<std::vector<std::string>>{
           {"sample", "dragon", "-o", out},
           {"sample", "hand", "--pose", "flying", "-o", out},
           {"sample", "hand", "--faces", "10", "-o", out},
           {"sample", "hand", "-o", folder / "x.txt"},
           {"sample", "hand", "-o", folder / "x.drc", "--parts",
            folder / "x.seg"}}) {
    EXPECT_EQ(Marrow(arguments).code, 2) << arguments[1];
  }
  EXPECT_THAT(ListFolder(folder.path()), IsEmpty());
  EXPECT_THAT(Marrow({"sample", "hand", "-o", folder / "x.xyz"}).err,
              HasSubstr("x.xyz: cannot write this format; use .off, .obj, "
                        ".ply, .stl or .drc"));
}

TEST(MarrowTest, QuantizingWhatIsSentAsItIsIsWarnedOf) {
  const TemporaryFolder folder;
  const std::string path = folder / "hand.drc";
  ASSERT_EQ(Marrow({"sample", "hand", "--faces", "5000", "-o", path}).code, 0);
  const std::string warning = "marrow: " + path +
                              ": warning: --quantize has no effect on a Draco "
                              "file, which is sent as it is\n";
  EXPECT_EQ(Marrow({"inspect", path, "--quantize", "9"}).err, warning);
  EXPECT_EQ(Marrow({"spectrum", path, "-k", "2", "--quantize", "9"}).err,
            warning);
  EXPECT_EQ(Marrow({"segment", path, "--levels", "1", "--quantize", "9", "-o",
                    folder / "out"})
                .err,
            warning);
  EXPECT_EQ(Marrow({"inspect", path, "--quantize", "9", "-q"}).err, "");
  EXPECT_EQ(Marrow({"inspect", path}).err, "");
}

TEST(MarrowTest, AServerThatIsNotThereIsToldWithinSeconds) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  const auto start = std::chrono::steady_clock::now();
  const Finished run = Marrow({"segment", folder / "t.off", "-o",
                               folder / "out", "--server", "127.0.0.1:1"});
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, HasSubstr("127.0.0.1:1"));
  EXPECT_THAT(run.err, HasSubstr("marrowd"));
  const Finished health = Marrow({"health", "--server", "127.0.0.1:1"});
  EXPECT_EQ(health.code, 3);
  EXPECT_THAT(health.err, HasSubstr("127.0.0.1:1: nothing answers"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20));
}

TEST(MarrowTest, ATimeoutBoundsTheWaitForAServer) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  const auto start = std::chrono::steady_clock::now();
  const Finished run = Marrow({"inspect", folder / "t.off", "--server",
                               "127.0.0.1:1", "--timeout", "0.5"});
  EXPECT_EQ(run.code, 3);
  EXPECT_THAT(run.err, ::testing::ContainsRegex("waited [1-5]00ms"));
  EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(4));
}

TEST(MarrowTest, AnEndlessFileIsRefused) {
  const Finished run = Marrow({"inspect", "/dev/zero"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("/dev/zero: is larger than 1 GiB"));
}

TEST(MarrowTest, AClosedInputIsEmpty) {
  for (const char* command : {"inspect", "spectrum", "segment -q"}) {
    const Finished run = RunProgram(
        {"/bin/sh", "-c",
         "timeout 20 " + ProgramPath("marrow") + " " + command + " - <&-"});
    EXPECT_EQ(run.code, 1) << command;
    EXPECT_THAT(run.err, HasSubstr("marrow: -: is empty")) << command;
  }
}

TEST(MarrowTest, AFullDiskIsNoSuccess) {
  const Finished run = RunProgram(
      {"/bin/sh", "-c", ProgramPath("marrow") + " sample --list >/dev/full"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("standard output"));
}

TEST(MarrowTest, AReaderThatWentAwayIsNoFailure) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  // The first prints at its end, the second line by line.
  for (const std::string& arguments :
       {std::string(" sample --list"),
        " inspect --json " + (folder / "t.off")}) {
    const Finished run =
        RunProgram({"/bin/sh", "-c",
                    "{ sleep 0.2; " + ProgramPath("marrow") + arguments +
                        "; echo $? >&2; } | true"});
    EXPECT_EQ(run.err, "0\n") << arguments;
  }
}

TEST(MarrowTest, AClosedOutputIsTold) {
  const TemporaryFolder folder;
  WriteFile(folder / "t.off", kTetrahedron);
  const Finished run = RunProgram(
      {"/bin/sh", "-c",
       ProgramPath("marrow") + " inspect " + (folder / "t.off") + " >&-"});
  EXPECT_EQ(run.code, 1);
  EXPECT_THAT(run.err, HasSubstr("standard output: it is closed"));
}

}  // namespace
}  // namespace marrow
