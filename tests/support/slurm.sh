#!/bin/bash
# slurm.sh WORK BIN: the checks behind tests/stages/slurm.cmake. Exit code 77: no Slurm to test with.
set -u
work=$1 bin=$2 s=$1/slurm
skip() { echo "skipped: $1"; exit 77; }
[ "$(id -u)" = 0 ] || skip "not root"
for program in slurmctld slurmd munged sbatch srun scontrol; do command -v $program > /dev/null || skip "no $program (slurm-wlm, munge)"; done
export PATH=$bin:$PATH SLURM_CONF=$s/slurm.conf

mkdir -p $s/{state,spool,log}
head -c 128 /dev/urandom > $s/munge.key
chown munge: $s/munge.key $s/log && chmod 400 $s/munge.key
mkdir -m 755 $s/munge && chown munge: $s/munge
# munged refuses folders that others may change; below /tmp and the like it must be forced
setpriv --reuid munge --regid munge --clear-groups munged --force --key-file=$s/munge.key --socket=$s/munge/socket --pid-file=$s/munge/pid \
  --log-file=$s/munge/log --seed-file=$s/munge/seed > $s/log/munged 2>&1 || skip "munged does not start: $(tail -1 $s/log/munged)"

host=$(hostname -s)
cpus=$(nproc)
cat > $s/slurm.conf <<END
ClusterName=langer
SlurmctldHost=$host(127.0.0.1)
SlurmUser=root
SlurmdUser=root
AuthType=auth/munge
AuthInfo=socket=$s/munge/socket,cred_expire=5
CryptoType=crypto/munge
SlurmctldPort=17817
SlurmdPort=17818
StateSaveLocation=$s/state
SlurmdSpoolDir=$s/spool
SlurmctldPidFile=$s/slurmctld.pid
SlurmdPidFile=$s/slurmd.pid
SlurmctldLogFile=$s/log/slurmctld
SlurmdLogFile=$s/log/slurmd
ProctrackType=proctrack/pgid
TaskPlugin=task/none
MpiDefault=none
SwitchType=switch/none
SelectType=select/cons_tres
SelectTypeParameters=CR_CPU
SchedulerParameters=sched_interval=1,bf_interval=1
SchedulerTimeSlice=5
KillWait=10
ReturnToService=2
JobRequeue=1
MinJobAge=600
NodeName=$host NodeAddr=127.0.0.1 CPUs=$cpus State=UNKNOWN
PartitionName=all Nodes=$host Default=YES MaxTime=1:00:00 State=UP OverSubscribe=NO
END
stop() {
  for pid in $s/slurmd.pid $s/slurmctld.pid $s/munge/pid; do [ -s $pid ] && kill "$(cat $pid)" 2> /dev/null; done
  for i in $(seq 50); do
    alive=
    for pid in $s/slurmd.pid $s/slurmctld.pid; do [ -s $pid ] && kill -0 "$(cat $pid)" 2> /dev/null && alive=1; done
    [ -z "$alive" ] && break
    sleep 0.1
  done
}
trap stop EXIT
fail() {
  echo "FAILED: $*"
  tail -n 15 $s/log/slurmctld $s/log/slurmd
  squeue -a
  exit 1
}
slurmctld -c -i > $s/log/start 2>&1 || skip "slurmctld does not start: $(tail -1 $s/log/start)"
slurmd > $s/log/start 2>&1 || skip "slurmd does not start: $(tail -1 $s/log/start)"
for i in $(seq 100); do
  sinfo -h -o %t 2> /dev/null | grep -q '^idle$' && break
  sleep 0.2
done
sinfo -h -o %t | grep -q '^idle$' || skip "this machine cannot be a node of Slurm: $(sinfo -h 2>&1 | head -1)"
echo "Slurm $(sinfo -V | cut -d' ' -f2), $cpus processors"
settled() { # until no job of ours is left
  for i in $(seq 600); do
    [ -z "$(squeue -h)" ] && return
    sleep 0.3
  done
  fail "jobs do not end"
}

cd $work/project || exit 1
# 1. a sweep with a member that cannot succeed: it stops at once, the others and their tables of results are made
sed -e '/^  table:/,$d' -e 's/values: \[0, 60\]/values: [0, 60]/' pipelines/smoke.yaml > sweep.yaml
sed -i 's/^pipeline: .*/pipeline: sweep/; s|set: {starts: 2, study.bootstrap: 5|set: {starts: 2, study.bootstrap: 5|' sweep.yaml
python3 - <<'END' 2> /dev/null || perl -0pi -e 's/sweep:\n      alpha: .*\n/sweep:\n      way: {variants: {good: {}, other: {"fibre_angles[0]": 30}, bad: {path.first: 0.5, solver.newton.iterations: 1, path.smallest: 0.4}}}\n/' sweep.yaml
import re
text = open("sweep.yaml").read()
text = re.sub(r"sweep:\n      alpha: .*\n", 'sweep:\n      way: {variants: {good: {}, other: {"fibre_angles[0]": 30}, bad: {path.first: 0.5, solver.newton.iterations: 1, path.smallest: 0.4}}}\n', text)
open("sweep.yaml", "w").write(text)
END
langer-plan sweep.yaml --slurm || fail "langer-plan --slurm"
runs/sweep/slurm/submit --cpus-per-task=1 || fail "slurm/submit"
settled
langer times runs/sweep > times; cat times
for member in way_good way_other; do [ -s runs/sweep/$member/post/curves.h5 ] || fail "$member was not made"; done
[ ! -e runs/sweep/way_bad/post/curves.h5 ] || fail "the bad member was made"
grep -q 'way_bad/solve/solution: exit 4; log: runs/sweep/way_bad/solve/solution.log' times || fail "the failed member is not named"
grep -q 'not run: these inputs are missing: way_bad/solve/solution.h5' runs/sweep/slurm/post_*.txt || fail "the member behind it does not say why it did not run"
# sent again, what is up to date ends at once: no log is newer
touch before
runs/sweep/slurm/submit > /dev/null && settled
[ -z "$(find runs/sweep/way_good runs/sweep/way_other runs/sweep/mesh -newer before -name '*.h5')" ] || fail "made again without need"

# 2. preempted: requeued in the middle of its path, it goes on after the steps that it kept
cat > long.yaml <<END
pipeline: long
nodes:
  mesh: {stage: mesh, config: configs/mesh/indentation_coarse.yaml}
  solve:
    stage: solve
    config: configs/solve/indentation.yaml
    mesh: mesh
    material: configs/material/abdomen_hgo_yeoh.yaml
    set: {path: {first: 0.01, largest: 0.01}}
    sweep: {contact: {variants: {smooth: {contacts.sphere.friction: 0}, rough: {contacts.sphere.friction: 0.34}}}}
END
langer-plan long.yaml --slurm --quiet || fail "langer-plan long.yaml"
runs/long/slurm/submit > sent || fail "slurm/submit"
log=runs/long/contact_rough/solve/solution.log
for i in $(seq 600); do
  grep -q '^step  *5 ' $log 2> /dev/null && break
  sleep 0.1
done
grep -q '^step  *5 ' $log || fail "the long run does not begin"
job=$(sed -n 's/^solve: .*job //p' sent)_2
scontrol requeue $job || fail "requeue of $job"
settled
[ -s runs/long/contact_rough/solve/solution.h5 ] || fail "the requeued member was not made: $(tail -3 $log)"
continued=$(sed -n 's/^solve: continues after \([0-9]*\) steps.*/\1/p' $log)
[ "${continued:-0}" -ge 5 ] || fail "the requeued member began again: $(head -5 $log)"
echo "requeued: went on after $continued steps"
langer-solve runs/long/contact_rough/solve/solve.yaml --mesh runs/long/mesh/mesh.h5 --material configs/material/abdomen_hgo_yeoh.yaml --quiet \
  -o straight.h5 || fail "the same without Slurm"
langer-compare-h5 straight.h5 runs/long/contact_rough/solve/solution.h5 1e-9 --data || fail "the requeued run has other results"

# 3. make inside an allocation, every step a job step
sed 's/^pipeline: .*/pipeline: launched/' pipelines/smoke.yaml > launched.yaml
langer-plan launched.yaml --quiet || fail "langer-plan launched.yaml"
salloc --quiet -n $cpus make --no-print-directory -C runs/launched -j64 LAUNCH="srun --quiet -n1 --exact" || fail "make with LAUNCH=srun"
[ -s runs/launched/table/table.csv ] || fail "no table"
echo "launched: $(find runs/launched -name '*.log' | wc -l) steps by srun"

# 4. one solution by two ranks of a job step, and a pipeline whose steps all have two: those of other programs leave
if ! langer doctor 2> /dev/null | grep -q "yes  petsc" || ! srun --mpi=list 2>&1 | grep -q pmix; then
  echo "two ranks: not tried, PETSc or Slurm's PMIx is not here"
  exit 0
fi
srun="srun --quiet --mpi=pmix -n 2 --kill-on-bad-exit"
set -- langer-solve configs/solve/smoke.yaml --mesh runs/launched/mesh/mesh.h5 --material configs/material/abdomen_hgo_yeoh.yaml \
  --set symmetry=none --set solver.newton.linear=iterative --set solver.newton.relative=1e-10
"$@" --quiet -o alone.h5 || fail "the same by one rank"
timeout 120 $srun "$@" -o ranks.h5 > ranks.txt 2>&1 || fail "srun of two ranks: $(cat ranks.txt)"
[ "$(grep -c '; 2 ranks$' ranks.txt)" = 1 ] || fail "two ranks do not say so, once: $(cat ranks.txt)"
for name in VTKHDF/PointData/u VTKHDF/PointData/reaction history/force_ind; do
  langer-compare-h5 alone.h5 ranks.h5 1e-8 --data 2>&1 | grep -q "$name:" && fail "two ranks and one differ in $name"
done
timeout 120 $srun "$@" --set path.frist=1 -o no.h5 > wrong.txt 2>&1
[ $? = 2 ] && [ "$(grep -c 'unknown key' wrong.txt)" = 1 ] || fail "an error of two ranks: $(cat wrong.txt)"
timeout 120 srun --quiet --mpi=none -n 2 "$@" -o lonely.h5 > lonely.txt 2>&1 || fail "two processes that do not know of each other: $(cat lonely.txt)"
langer-compare-h5 alone.h5 lonely.h5 0 --data || fail "one of two processes has another result"
[ "$(grep -c '1 of 2 ranks idle: .*srun --mpi=pmix' lonely.txt)" = 1 ] || fail "nothing says how ranks get to know of each other: $(cat lonely.txt)"
sed -e 's/^pipeline: .*/pipeline: shared/' -e 's/^    sweep:/    set: {symmetry: none, solver.newton.linear: iterative}\n    sweep:/' pipelines/smoke.yaml > shared.yaml
langer-plan shared.yaml --quiet || fail "langer-plan shared.yaml"
salloc --quiet -n 2 make --no-print-directory -C runs/shared -j1 LAUNCH="$srun" > shared.txt 2>&1 || fail "make with ranks: $(tail -20 shared.txt)"
[ "$(grep -l '; 2 ranks$' runs/shared/*/solve/solution.log | wc -l)" = 2 ] || fail "the solves of the pipeline are not shared: $(cat runs/shared/*/solve/solution.log)"
[ -s runs/shared/table/table.csv ] || fail "no table of ranks"
echo "two ranks: by srun, and in every step of a pipeline"
