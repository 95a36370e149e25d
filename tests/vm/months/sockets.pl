# Asks for sockets of each family that reaches beyond the machine: all must be refused; a local one is allowed.
use strict;
use warnings;
my %families = (INET => 2, INET6 => 10, PACKET => 17, BLUETOOTH => 31, VSOCK => 40, CAN => 29);
my $failed = 0;
for my $name (sort keys %families) {
    my $had = socket(my $socket, $families{$name}, 2, 0);
    print "AF_$name: ", ($had ? "allowed" : "refused: $!"), "\n";
    $failed = 1 if $had || !$!{EAFNOSUPPORT};
}
$failed = 1 unless socket(my $local, 1, 2, 0);
exit $failed;
