// The paper's Table 1 on meshes of the same sizes, as a Markdown table.
//
// The paper's models are not free to pass on, so each row is a sample creature
// of that many vertices; those above 25k vertices are subdivided once, every
// face into four.
#ifndef MARROW_TESTS_BENCH_TABLE_ONE_H_
#define MARROW_TESTS_BENCH_TABLE_ONE_H_

namespace marrow {

// Prints the table; the value is an exit code.
int PrintTableOne();

}  // namespace marrow

#endif  // MARROW_TESTS_BENCH_TABLE_ONE_H_
