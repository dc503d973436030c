#pragma once
// What a child of the server does: one batch of grains or faces with one mesher.

namespace polyslip::mesh::worker {

/// Reads a batch from the socket, answers grain by grain or face by face
/// (mesh/mesher_protocol.hpp), ends the process: code 0, or 1 after a failed one. CPU time is
/// limited for each by the batch's timeout (SIGXCPU), wall time of one that waits for nothing by a
/// generous alarm (SIGALRM).
[[noreturn]] void serve_batch(int socket);

}  // namespace polyslip::mesh::worker
