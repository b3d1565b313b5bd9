#!/bin/sh
# A table as a job array of a real Slurm, one controller and one node on the loopback interface,
# merged and compared with a run in one piece. Needs root and the Debian packages slurmctld, slurmd,
# slurm-client and munge; exit code 77 (skipped) without them.
#   slurm_test.sh PROGRAM ROBOT.yaml
set -eu

program=$(readlink -f "$1")
robot=$(readlink -f "$2")
skip() { echo "skipped: $1"; exit 77; }
[ "$(id -u)" -eq 0 ] || skip "needs root"
for tool in slurmctld slurmd sbatch munged; do
  command -v "$tool" >/dev/null || skip "$tool is not installed"
done

work=$(mktemp -d)
pids=""
finish() {
  for pid in $pids; do kill "$pid" 2>/dev/null || true; done
  for pid in $pids; do
    tries=0
    while kill -0 "$pid" 2>/dev/null && [ "$tries" -lt 20 ]; do sleep 0.2; tries=$((tries + 1)); done
    kill -9 "$pid" 2>/dev/null || true
  done
  rm -rf "$work"
}
trap finish EXIT
fail() {
  echo "failed: $1" >&2
  tail -n 20 "$work"/*.log "$work"/*.txt >&2 2>/dev/null || true
  exit 1
}

# Keys and sockets of our own, so that nothing else on this machine is affected.
mkdir -p "$work/state" "$work/spool"
chmod 755 "$work"
dd if=/dev/urandom of="$work/munge.key" bs=1 count=1024 2>/dev/null
chmod 400 "$work/munge.key"
munged --force --foreground --key-file="$work/munge.key" --socket="$work/munge.socket" \
  --pid-file="$work/munged.pid" --log-file="$work/munged.log" --seed-file="$work/munge.seed" \
  >"$work/munged.txt" 2>&1 &
pids="$pids $!"

host=$(hostname -s)
cat >"$work/slurm.conf" <<CONF
ClusterName=loopback
SlurmctldHost=$host(127.0.0.1)
SlurmctldPort=26817
SlurmdPort=26818
SlurmUser=root
AuthType=auth/munge
AuthInfo=socket=$work/munge.socket
CredType=cred/munge
MpiDefault=none
ProctrackType=proctrack/pgid
TaskPlugin=task/none
ReturnToService=2
StateSaveLocation=$work/state
SlurmdSpoolDir=$work/spool
SlurmctldPidFile=$work/slurmctld.pid
SlurmdPidFile=$work/slurmd.pid
SlurmctldLogFile=$work/slurmctld.log
SlurmdLogFile=$work/slurmd.log
SchedulerType=sched/builtin
SelectType=select/cons_tres
SelectTypeParameters=CR_Core
AccountingStorageType=accounting_storage/none
JobAcctGatherType=jobacct_gather/none
NodeName=$host NodeAddr=127.0.0.1 CPUs=2 State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=INFINITE State=UP
CONF
export SLURM_CONF="$work/slurm.conf"
slurmctld -D >"$work/slurmctld.txt" 2>&1 &
pids="$pids $!"
slurmd -D -N "$host" >"$work/slurmd.txt" 2>&1 &
pids="$pids $!"
tries=0
until sinfo -h -o %t 2>/dev/null | grep -q idle; do
  tries=$((tries + 1))
  [ "$tries" -lt 60 ] || fail "the node did not come up"
  sleep 0.5
done

mkdir "$work/scenarios"
cat >"$work/scenarios/three_routes_a.yaml" <<YAML
name: three_routes_a
robot: $robot
actions: [walk]
start: {action: walk, x: 1.2, y: 0, yaw_deg: 0}
goal: {action: walk, x: 2.8, y: 0, yaw_deg: 0}
time_limit: 60
environment:
  bounds: {x: [0, 4], y: [-2, 2]}
  ground:
    - {name: floor, size: [4, 4, 0.5], position: [2, 0, -0.25]}
  obstacles:
    - {name: post, shape: box, size: [0.1, 0.1, 1], position: [0.1, 1.9, 0.5]}
YAML
cat >"$work/array.sh" <<SH
#!/bin/sh
cd "$work"
exec "$program" table --scenarios scenarios --scenario three_routes_a_1 --trials 7 --threads 1 \
  --out "parts/\$SLURM_ARRAY_TASK_ID"
SH
cd "$work"
# The array starts at 1: parts are counted from its first task.
sbatch --wait --array=1-3 --output="$work/job-%a.txt" "$work/array.sh" >/dev/null ||
  fail "the job array failed"
"$program" merge parts/1 parts/2 parts/3 --out merged >merge.txt 2>&1 || fail "merge failed"
"$program" table --scenarios scenarios --scenario three_routes_a_1 --trials 7 --out whole \
  >whole.txt 2>&1 || fail "the run in one piece failed"

# The lines without fields that depend on the machine's speed and on the process's history.
facts() {
  sed -E 's/"(preparation|graph|confirmation|motion|verification)_s":[^,]*,//g;
          s/"(real_time_ratio|memory_mb)":[^,]*,//g' "$1"
}
for part in 1 2 3; do
  lines=$(wc -l <"parts/$part/results.jsonl")
  [ "$lines" -ge 2 ] || fail "part $part has $lines trials, expected 2 or 3"
done
[ "$(wc -l <merged/results.jsonl)" -eq 7 ] || fail "the merged file does not have 7 trials"
facts merged/results.jsonl >merged.facts
facts whole/results.jsonl >whole.facts
cmp merged.facts whole.facts || fail "the parts do not merge to the whole"
echo "3 tasks of a Slurm array merged to the same 7 trials as one run"
