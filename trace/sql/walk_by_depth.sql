-- Pairs of tree nodes by the number of pairs above them (recorded with --events nodes): their number, how
-- many of them ended because no boxes overlapped, and their box tests. The sums over all rows are node_pairs
-- and box_tests of summary.json's counters.
SELECT
  EXTRACT_ARG(arg_set_id, 'args.pairs above') AS pairs_above,
  COUNT(*) AS node_pairs,
  SUM(EXTRACT_ARG(arg_set_id, 'args.boxes that meet') = 0) AS ended,
  SUM(EXTRACT_ARG(arg_set_id, 'args.box tests')) AS box_tests
FROM slice
WHERE name = 'node pair'
GROUP BY pairs_above
ORDER BY pairs_above;
