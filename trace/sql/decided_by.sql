-- Face tests by the deciding arithmetic, and their durations (recorded with --events nodes; times on the wall
-- clock, in nanoseconds, recording included).
SELECT
  EXTRACT_ARG(arg_set_id, 'args.decided by') AS decided_by,
  COUNT(*) AS face_tests,
  SUM(dur) AS ns
FROM slice
WHERE name = 'face test'
GROUP BY decided_by
ORDER BY face_tests DESC;
