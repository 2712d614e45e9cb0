"""Plants every kind of violation and expects it to be found, and it alone."""

import pathlib
import tempfile
import unittest

import include_directions


class IncludeDirectionsTest(unittest.TestCase):

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.root = pathlib.Path(folder.name)
        self.write("core/mesh/decode.cc", "<draco/mesh/mesh.h>",
                   '"core/mesh/decode.h"', '"core/base/digest.h"', "<vector>")
        self.write("core/spectrum/solver.cc", "<Spectra/SymGEigsSolver.h>",
                   '"core/mesh/triangle_mesh.h"', '"absl/status/status.h"')
        self.write("server/status.cc", "<grpcpp/grpcpp.h>",
                   '"core/pipeline/pipeline.h"', '"marrow/v1/mesh.pb.h"',
                   body="return grpc::Status(grpc::StatusCode::OK, text);")
        self.write("server/server.cc", '"server/server.h"')
        self.write("client/encoder/encode.cc", '"draco/mesh/mesh.h"',
                   '"core/mesh/decode.h"')
        self.write("client/command/embedded.cc", '"server/server.h"')

    def write(self, name, *includes, body=""):
        path = self.root / name
        path.parent.mkdir(parents=True, exist_ok=True)
        lines = [f"#include {included}" for included in includes]
        path.write_text("\n".join(lines + [body]) + "\n")

    def expect(self, *words):
        found = include_directions.violations(self.root)
        self.assertEqual(len(found), 1, found)
        for word in words:
            self.assertIn(word, found[0])

    def test_finds_nothing_in_order(self):
        self.assertEqual(include_directions.violations(self.root), [])

    def test_finds_an_include_to_the_right(self):
        self.write("core/mesh/a.cc", '"core/spectrum/solver.h"')
        self.expect("core/mesh/a.cc", "core/spectrum/solver.h")

    def test_finds_every_service_header_in_core(self):
        for header in ("<grpcpp/grpcpp.h>", '"google/protobuf/message.h"',
                       '"marrow/v1/mesh.pb.h"', "<hiredis/hiredis.h>",
                       "  <sys/socket.h>"):
            with self.subTest(header):
                self.write("core/pipeline/a.h", header)
                self.expect("core/pipeline/a.h", "core knows nothing")

    def test_finds_core_including_server_and_client(self):
        self.write("core/pipeline/a.cc", '"client/segmentation.h"')
        self.expect("core must not include client")

    def test_finds_server_including_client(self):
        self.write("server/a.cc", '"client/segmentation.h"')
        self.expect("server must not include client")

    def test_finds_product_including_tests(self):
        self.write("server/a.cc", '"tests/testing/shapes.h"')
        self.expect("server must not include tests")

    def test_finds_client_including_geometry_of_core(self):
        self.write("client/a.cc", '"core/mesh/triangle_mesh.h"')
        self.expect("client must not include core/mesh")

    def test_finds_an_unknown_folder_of_core(self):
        self.write("server/a.cc", '"core/util/misc.h"')
        self.expect("core/util is not a folder")

    def test_finds_a_second_file_with_spectra(self):
        self.write("core/spectrum/a.cc", "<Spectra/SymGEigsSolver.h>")
        self.expect("core/spectrum/a.cc, core/spectrum/solver.cc", "Spectra")

    def test_finds_spectra_elsewhere(self):
        self.write("core/pieces/a.cc", "<Spectra/SymGEigsSolver.h>")
        self.expect("core/pieces/a.cc", "Spectra")

    def test_finds_a_third_file_with_draco(self):
        self.write("client/command/a.cc", "<draco/mesh/mesh.h>")
        self.expect("client/command/a.cc", "Draco")

    def test_finds_draco_in_the_server(self):
        self.write("server/a.cc", "<draco/mesh/mesh.h>")
        self.expect("server/a.cc", "Draco")

    def test_finds_a_second_embedded_server(self):
        self.write("client/a.cc", '"server/server.h"')
        self.expect("client/a.cc", "the embedded server")

    def test_finds_a_second_maker_of_grpc_statuses(self):
        self.write("server/a.cc",
                   body="return grpc::Status(grpc::StatusCode::INTERNAL, x);")
        self.expect("server/a.cc", "server/status.cc")


if __name__ == "__main__":
    unittest.main()
