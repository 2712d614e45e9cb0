"""A client written from the .proto files alone gets the labels of `marrow`.

Nothing of Marrow's own client is used to talk to the server: the stubs are
made from proto/, and the answer is put together by what the .proto says.

Usage: python_client_test.py PROTO_FOLDER BIN_FOLDER
"""

import glob
import hashlib
import json
import os
import struct
import subprocess
import sys
import tempfile
import unittest

import grpc

PROTO_FOLDER, BIN_FOLDER = sys.argv[1:3]
CHUNK = 8 * 1024  # several to a mesh of some thousand faces


def program(name):
    return os.path.join(BIN_FOLDER, name)


def make_stubs(folder):
    protos = glob.glob(os.path.join(PROTO_FOLDER, "marrow/v1/*.proto"))
    subprocess.run(
        ["protoc", "-I", PROTO_FOLDER, "--python_out", folder, "--grpc_out",
         folder, "--plugin=protoc-gen-grpc=/usr/bin/grpc_python_plugin"]
        + protos, check=True)
    sys.path.insert(0, folder)


def labels_of(events, domain):
    """Level -> node ids, checked for order and number."""
    labels = {}
    totals = {}
    for event in events:
        if event.WhichOneof("event") != "labels":
            continue
        chunk = event.labels
        if chunk.domain != domain:
            continue
        known = labels.setdefault(chunk.level, [])
        assert chunk.first_index == len(known)
        known.extend(struct.unpack("<%dI" % (len(chunk.labels) // 4),
                                   chunk.labels))
        totals[chunk.level] = chunk.total_count
    for level, known in labels.items():
        assert len(known) == totals[level]
    return labels


def details_of(error):
    """Message name -> detail of a failed call."""
    from marrow.v1 import error_details_pb2 as pb
    trailer = dict(error.trailing_metadata())["grpc-status-details-bin"]
    result = {}
    for packed in pb.RpcStatus.FromString(trailer).details:
        prefix, name = packed.type_url.rsplit(".", 1)
        assert prefix == "type.googleapis.com/google.rpc", packed.type_url
        result[name] = getattr(pb, name).FromString(packed.value)
    return result


def tree_of(events):
    """Node id -> what the events say of it, their lists joined."""
    nodes = {}
    for event in events:
        for node in event.level.nodes:
            known = nodes.setdefault(node.id, {"medial": b""})
            if "level" not in known:
                known["level"] = node.level
                known["parent"] = (
                    node.parent if node.HasField("parent") else None)
            known["medial"] += node.medial_structure
        for split in [*event.level.splits, *event.completed.splits]:
            nodes[split.id]["children"] = list(split.children)
            nodes[split.id]["iterations"] = split.iterations
    return nodes


class PythonClientTest(unittest.TestCase):

    @classmethod
    def setUpClass(cls):
        cls.folder = tempfile.TemporaryDirectory()
        make_stubs(cls.folder.name)
        cls.server = subprocess.Popen(
            [program("marrowd"), "--port", "0", "--log-level", "off"],
            stdout=subprocess.PIPE, text=True)
        line = cls.server.stdout.readline().strip()
        cls.address = line[line.index("listening on ") + 13:]
        cls.channel = grpc.insecure_channel(cls.address)
        cls.path = os.path.join(cls.folder.name, "me.drc")
        subprocess.run([program("marrow"), "sample", "quadruped", "--faces",
                        "6000", "-o", cls.path],
                       check=True, stdout=subprocess.DEVNULL)
        with open(cls.path, "rb") as file:
            cls.draco = file.read()

    @classmethod
    def tearDownClass(cls):
        cls.channel.close()
        cls.server.terminate()
        code = cls.server.wait(60)
        cls.server.stdout.close()
        cls.folder.cleanup()
        assert code == 0, code

    def segment(self, **mesh):
        from marrow.v1 import mesh_pb2
        from marrow.v1 import segmentation_service_pb2 as pb
        from marrow.v1 import segmentation_service_pb2_grpc as rpc
        stub = rpc.SegmentationServiceStub(self.channel)
        request = pb.SegmentRequest(mesh=mesh_pb2.MeshSource(**mesh))
        return list(stub.Segment(request, timeout=60))

    def digest(self):
        from marrow.v1 import mesh_pb2
        return mesh_pb2.MeshDigest(sha256=hashlib.sha256(self.draco).digest(),
                                   size_bytes=len(self.draco))

    def marrow_result(self, name):
        out = os.path.join(self.folder.name, "out")
        if not os.path.exists(out):
            subprocess.run([program("marrow"), "segment", self.path, "-o",
                            out], check=True, stdout=subprocess.DEVNULL)
        with open(os.path.join(out, "me." + name), encoding="utf-8") as file:
            return file.read()

    def marrow_labels(self, level):
        text = self.marrow_result("level-%d.seg" % level)
        return [int(line) for line in text.splitlines()]

    def test_labels_are_those_of_marrow(self):
        events = self.segment(draco=self.draco)
        kinds = [event.WhichOneof("event") for event in events]
        self.assertEqual(kinds[0], "accepted")
        self.assertEqual(kinds[-1], "completed")
        self.assertEqual([event.sequence for event in events],
                         list(range(1, len(events) + 1)))
        labels = labels_of(events, 1)
        self.assertGreaterEqual(len(labels), 2)
        for level, known in labels.items():
            self.assertEqual(known, self.marrow_labels(level))

    def test_the_tree_is_that_of_marrow(self):
        nodes = tree_of(self.segment(draco=self.draco))
        expected = json.loads(self.marrow_result("json"))["tree"]["nodes"]
        self.assertEqual(sorted(nodes), [node["id"] for node in expected])
        for node in expected:
            known = nodes[node["id"]]
            for field in ("parent", "children", "level", "iterations"):
                self.assertEqual(known[field], node[field], node["id"])
            medial = struct.unpack("<%dI" % (len(known["medial"]) // 4),
                                   known["medial"])
            self.assertEqual(list(medial), node["medial_structure"])

    def test_a_mesh_is_uploaded_and_then_named(self):
        from marrow.v1 import mesh_store_service_pb2 as pb
        from marrow.v1 import mesh_store_service_pb2_grpc as rpc

        def parts():
            yield pb.UploadMeshRequest(header=self.digest())
            for offset in range(0, len(self.draco), CHUNK):
                yield pb.UploadMeshRequest(chunk=pb.UploadMeshRequest.Chunk(
                    offset=offset, data=self.draco[offset:offset + CHUNK]))

        with self.assertRaises(grpc.RpcError) as caught:
            self.segment(digest=type(self.digest())(
                sha256=bytes(32), size_bytes=1))
        self.assertEqual(caught.exception.code(),
                         grpc.StatusCode.FAILED_PRECONDITION)
        details = details_of(caught.exception)
        self.assertEqual(details["ErrorInfo"].reason, "MESH_MISSING")
        violation = details["PreconditionFailure"].violations[0]
        self.assertEqual(violation.type, "MESH_MISSING")
        self.assertEqual(violation.subject, "00" * 32)
        self.assertGreater(len(self.draco), 2 * CHUNK)
        store = rpc.MeshStoreServiceStub(self.channel)
        store.UploadMesh(parts(), timeout=60)
        named = labels_of(self.segment(digest=self.digest()), 1)
        inline = labels_of(self.segment(draco=self.draco), 1)
        self.assertEqual(named, inline)

    def test_a_bad_parameter_names_its_field(self):
        from marrow.v1 import mesh_pb2
        from marrow.v1 import segmentation_service_pb2 as pb
        from marrow.v1 import segmentation_service_pb2_grpc as rpc
        stub = rpc.SegmentationServiceStub(self.channel)
        request = pb.SegmentRequest(
            mesh=mesh_pb2.MeshSource(draco=self.draco),
            options=pb.SegmentationOptions(kappa=-1))
        with self.assertRaises(grpc.RpcError) as caught:
            list(stub.Segment(request, timeout=60))
        error = caught.exception
        self.assertEqual(error.code(), grpc.StatusCode.INVALID_ARGUMENT)
        details = details_of(error)
        self.assertEqual(sorted(details), ["BadRequest", "ErrorInfo"])
        self.assertEqual(details["ErrorInfo"].domain, "marrow")
        self.assertEqual(details["ErrorInfo"].reason, "INVALID_PARAMETER")
        fields = [v.field for v in details["BadRequest"].field_violations]
        self.assertEqual(fields, ["options.kappa"])


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
